"""Convert the Munsell data of luxpy to an atlas: ``make munsell`` writes
out/munsell.csv.

The data are 1,269 matt chips measured at the University of Joensuu, 380–800 nm at 1 nm.
luxpy is licensed under GPL-3, so the output is for local use only.
"""

import csv
import sys
from pathlib import Path

import numpy as np

from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.sources import write_atlas


def main(folder: str, output: str) -> None:
    """Convert the data of the luxpy installation in ``folder`` to a CSV
    atlas at 5 nm.
    """
    data = Path(folder) / "luxpy" / "data" / "rfls"
    table = np.loadtxt(data / "Munsell1269.dat", delimiter=",")
    lines = (
        (data / "Munsell1269NotationInfo.dat").read_text(encoding="utf-8").splitlines()
    )
    names = [
        f"{chip['H']} {float(chip['V']):g}/{float(chip['C']):g}"
        for chip in csv.DictReader(lines)
    ]
    repeats = [names[:row].count(name) + 1 for row, name in enumerate(names)]
    names = [
        name if repeat == 1 else f"{name} ({repeat})"
        for name, repeat in zip(names, repeats, strict=True)
    ]
    entries = (
        Entry(name, table[::5, 0], chip)
        for name, chip in zip(names, table[::5, 1:].T.round(4), strict=True)
    )
    write_atlas(Atlas(tuple(entries)), output, force=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
