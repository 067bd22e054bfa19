"""What docs/stability.md is made of: the failure map, and the sensitivity of stored cubes → docs/stability/."""

from __future__ import annotations

import json
import sys
import time
import warnings
from typing import Any

import uplift
from benchmarks.timing import ROOT
from uplift.lab.study import sensitivity
from uplift.lab.study.records import write_csv
from uplift.lab.study.sensitivity_plots import plot_locality, plot_steepness
from uplift.lab.study.stability import NO_ATLAS, study_stability
from uplift.lab.study.stability_design import DesignSpace, design, grids
from uplift.lab.study.stability_plots import plot_map
from uplift.lab.study.synthetic_atlases import SYNTHETIC_ATLASES
from uplift.lab.timing import environment
from uplift.pipeline.provenance import recorded_atlas

FOLDER = ROOT / "docs" / "stability"
MAP, FIGURES = FOLDER / "map.csv", FOLDER / "sensitivity.json"
PLAIN, CONSTRAINED = "moments-16", "moments-16-macbeth"
CUBES = (PLAIN, CONSTRAINED, "sigmoid-16", "sigmoid-16-macbeth", "moments-8", "sigmoid-8")
"""Of cubes/; the first two are drawn."""


def main() -> None:
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    FOLDER.mkdir(exist_ok=True)
    for part in (_map, _sensitivity):
        begin = time.perf_counter()
        part()
        print(f"{part.__name__[1:]}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)


def _map() -> None:
    macbeth = {"macbeth": uplift.read_atlas(ROOT / "atlases" / "macbeth.txt")}
    axes = DesignSpace(atlases=(NO_ATLAS, "macbeth", *SYNTHETIC_ATLASES))
    found = study_stability(
        design(axes), macbeth | {name: make() for name, make in SYNTHETIC_ATLASES.items()}, _say
    )
    write_csv([one.record() for one in found], MAP, force=True)
    plot_map(grids(axes), {one.setting: one for one in found}, FOLDER / "map.png", force=True)


def _sensitivity() -> None:
    figures: dict[str, Any] = {"circumstances": environment(), "cubes": {}}
    for name in CUBES:
        path = ROOT / "cubes" / f"{name}.uplift"
        cube = uplift.load(path)
        atlas = recorded_atlas(cube.data, path) if name == CONSTRAINED else None
        found = sensitivity.study_sensitivity(cube, atlas, 24)
        figures["cubes"][name] = found.record()
        if name in (PLAIN, CONSTRAINED):
            plot_steepness(cube.data, found.lipschitz, FOLDER / f"steepness-{name}.png", force=True)
        if found.removed:
            plot_locality(found.removed, FOLDER / "locality.png", force=True)
    FIGURES.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def _say(done: int, total: int) -> None:
    if done % 20 == 0 or done == total:
        print(f"{done} of {total} builds", file=sys.stderr)


if __name__ == "__main__":
    main()
