"""Accuracy, speed and memory of spectral textures: ``make textures``.

Writes docs/data/textures.json and docs/textures/relit.png.
"""

from __future__ import annotations

import sys
import time
import warnings

import uplift
from benchmarks.record import ROOT, write

PICTURES = ROOT / "docs" / "textures"


def main() -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    # First: a process started from a large one counts the memory of its parent as its own.
    from benchmarks.textures import speed

    begin = time.perf_counter()
    timings = speed.measure(str(ROOT / "cubes" / "moments-16-macbeth.uplift"))
    _print_time("speed", begin)
    from benchmarks.textures import accuracy, relit
    from benchmarks.textures.pictures import pictures

    macbeth = uplift.build(ROOT / "atlases" / "macbeth.txt", dim=32)
    PICTURES.mkdir(exist_ok=True)
    relighting = relit.draw(macbeth, next(iter(pictures())), PICTURES / "relit.png")
    figures = accuracy.measure(macbeth)
    _print_time("accuracy", begin)
    write("textures", "make textures", relighting=relighting, **figures, speed=timings)


def _print_time(part: str, begin: float) -> None:
    print(f"{part}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
