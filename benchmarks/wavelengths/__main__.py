"""``python -m benchmarks.wavelengths``."""

from __future__ import annotations

import sys
import time
import warnings

import uplift
from benchmarks.page import write
from benchmarks.timing import ROOT
from benchmarks.wavelengths import figures, meyer_tables
from benchmarks.wavelengths.bounces import bounces
from benchmarks.wavelengths.methods import SMOOTH, SPIKY, Comparison, compare, section, summary
from benchmarks.wavelengths.words import INTRODUCTION
from uplift.atlas import on_grid
from uplift.common.arrays import Array
from uplift.scene.wavelengths import grid, make_setup
from uplift.scene.wavelengths.experiments import run_trials
from uplift.scene.wavelengths.opponent import cone_space, opponent_space, xyz_space

MIXED = ("D65", "FL11")
"""Lights of several bounces."""
PICTURES = ROOT / "docs" / "wavelengths"


def main() -> None:
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = sorted((ROOT / "atlases").glob("*.txt"))
    checker = make_setup(on_grid(uplift.read_atlas(ROOT / "atlases" / "macbeth.txt"), grid()), ["C"])
    found = opponent_space(checker.wavelengths, checker.cmfs)
    PICTURES.mkdir(exist_ok=True)
    spaces = (found.space, cone_space(checker.wavelengths, checker.cmfs), xyz_space())
    tried = [run_trials(checker, space) for space in spaces]
    figures.figure_6(tried, PICTURES / "figure-6.png")
    figures.figure_7(tried[0], PICTURES / "figure-7.png")
    materials = on_grid(uplift.read_atlas(*atlases), grid())
    smooth, spiky = (_compared(materials, lights) for lights in (SMOOTH, SPIKY))
    figures.methods((smooth, spiky), PICTURES / "methods.png")
    sections = [
        summary((smooth, spiky), len(materials)),
        *(part for comparison in (smooth, spiky) for part in _sections(comparison)),
        bounces(materials, MIXED),
        meyer_tables.matrices(checker, found),
        meyer_tables.quadrature(checker, found.space),
        meyer_tables.four_wavelengths(checker, found.space),
    ]
    print(write("wavelengths", INTRODUCTION, sections))


def _compared(materials: Array, lights: tuple[str, ...]) -> Comparison:
    begin = time.perf_counter()
    found = compare(materials, lights)
    print(f"{', '.join(lights)}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return found


def _sections(found: Comparison) -> list[str]:
    lights = ", ".join(found.lights)
    words = "Mean / 95 % under / largest ΔE00 over materials and lights"
    return [
        section(f"Under {lights}: unseen materials", found.unseen, f"{words}; fitted to every other entry."),
        section(f"Under {lights}: all materials", found.seen, f"{words}; fitted to them all."),
    ]


if __name__ == "__main__":
    main()
