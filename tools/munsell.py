"""The Munsell book as an atlas, out of the data of luxpy: ``make munsell`` → out/munsell.csv.

1,269 matt chips measured at the University of Joensuu, 380–800 nm at 1 nm. luxpy (GPL-3) carries the table; the file
made here stays on the machine.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np


def main(folder: str, output: str) -> None:
    data = Path(folder) / "luxpy" / "data" / "rfls"
    table = np.loadtxt(data / "Munsell1269.dat", delimiter=",")
    with (data / "Munsell1269NotationInfo.dat").open(encoding="utf-8") as file:
        names = [f"{chip['H']} {float(chip['V']):g}/{float(chip['C']):g}" for chip in csv.DictReader(file)]
    wavelengths, values = table[::5, 0], table[::5, 1:]
    counts: dict[str, int] = {}
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    with Path(output).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["name", *(f"{wavelength:g}" for wavelength in wavelengths)])
        for name, column in zip(names, values.T, strict=True):
            counts[name] = counts.get(name, 0) + 1
            unique = name if counts[name] == 1 else f"{name} ({counts[name]})"
            writer.writerow([unique, *(f"{value:.4f}" for value in column)])


if __name__ == "__main__":
    main(*sys.argv[1:])
