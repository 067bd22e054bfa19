"""Selection of wavelengths: ``make wavelengths``.

Writes docs/data/wavelengths.json and the pictures of docs/wavelengths.
"""

from __future__ import annotations

import sys
import time
import warnings

import uplift
from benchmarks.record import ROOT, write
from benchmarks.wavelengths import figures, meyer_comparison
from benchmarks.wavelengths.bounces import LIGHTS, PATHS, bounces
from benchmarks.wavelengths.experiments import run_trials
from benchmarks.wavelengths.methods import SMOOTH, SPIKY, Comparison, compare, rows, summary
from uplift.atlas import on_grid
from uplift.common.arrays import Array
from uplift.scene.wavelengths import grid, make_setup
from uplift.scene.wavelengths.meyer import cone_space, opponent_space, xyz_space

PICTURES = ROOT / "docs" / "wavelengths"


def main() -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = sorted((ROOT / "atlases").glob("*.txt"))
    checker = make_setup(on_grid(uplift.read_atlas(ROOT / "atlases" / "macbeth.txt"), grid()), ["C"])
    opponent = opponent_space(checker.wavelengths, checker.cmfs)
    PICTURES.mkdir(exist_ok=True)
    spaces = (opponent.space, cone_space(checker.wavelengths, checker.cmfs), xyz_space())
    trials = [run_trials(checker, space) for space in spaces]
    figures.figure_6(trials, PICTURES / "figure-6.png")
    figures.figure_7(trials[0], PICTURES / "figure-7.png")
    materials = on_grid(uplift.read_atlas(*atlases), grid())
    comparisons = [_compare(materials, lights) for lights in (SMOOTH, SPIKY)]
    figures.methods(comparisons, PICTURES / "methods.png")
    write(
        "wavelengths",
        "make wavelengths",
        materials=len(materials),
        summary=[row for comparison in comparisons for row in summary(comparison)],
        errors=[row for comparison in comparisons for row in rows(comparison)],
        bounce_paths=PATHS,
        bounce_lights=LIGHTS,
        bounces=bounces(materials),
        **meyer_comparison.measure(checker, opponent),
    )


def _compare(materials: Array, lights: tuple[str, ...]) -> Comparison:
    begin = time.perf_counter()
    comparison = compare(materials, lights)
    print(f"{', '.join(lights)}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return comparison


if __name__ == "__main__":
    main()
