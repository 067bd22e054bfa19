"""Failure map of fits and sensitivity of stored cubes, for docs/stability.md and its pictures."""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Callable
from typing import Any

import click

import uplift
from benchmarks import CUBES, DATA, DOCS, MACBETH, record
from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.common.progress import Progress
from uplift.lab.study import sensitivity
from uplift.lab.study.sensitivity import MOVED_DELTA_E, NOISE
from uplift.lab.study.sensitivity_plots import plot_locality, plot_steepness
from uplift.lab.study.stability import NO_ATLAS, SYNTHETIC_ATLASES, DesignSpace, design, grids, study_stability
from uplift.lab.study.stability_plots import plot_map
from uplift.lab.timing import environment
from uplift.pipeline.rebuild import recorded_atlas

FOLDER = DOCS / "stability"
PLAIN, CONSTRAINED = "moments-16", "moments-16-macbeth"
STORED = (PLAIN, CONSTRAINED, "sigmoid-16", "sigmoid-16-macbeth", "moments-8", "sigmoid-8")
"""Stored cubes; the first two are plotted."""
QUERIES = 4096
CHANGE_KINDS: dict[str, Callable[[str], bool]] = {
    f"noise of {NOISE:g} on all entries": lambda change: change.startswith("noise"),
    "one entry reversed in wavelength": lambda change: change.endswith("wrong"),
    "one entry left out": lambda change: change.endswith("left out"),
}


@click.command()
@click.option("--keep-map", is_flag=True, help="Keep the stored failure map, which takes most of the time.")
def main(keep_map: bool) -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    FOLDER.mkdir(exist_ok=True)
    if keep_map:
        stored = json.loads((DATA / "stability.json").read_text(encoding="utf-8"))
        rows, map_environment = stored["map"], stored.get("map_environment", stored["environment"])
    else:
        rows, map_environment = failure_map(), environment()
    cubes = {name: cube_sensitivity(name) for name in STORED}
    record(
        "stability",
        light=NARROW_BAND_LIGHT,
        noise=NOISE,
        moved_delta_e=MOVED_DELTA_E,
        queries=QUERIES,
        plain=PLAIN,
        constrained=CONSTRAINED,
        map=rows,
        map_environment=map_environment,
        cubes=cubes,
        atlas_changes=atlas_changes(cubes[CONSTRAINED]["changes"]),
    )


def failure_map() -> list[dict[str, Any]]:
    """Run the builds of the design, and plot them."""
    macbeth = {"macbeth": uplift.read_atlas(MACBETH)}
    axes = DesignSpace(atlases=(NO_ATLAS, "macbeth", *SYNTHETIC_ATLASES))
    synthetic = {name: make() for name, make in SYNTHETIC_ATLASES.items()}
    results = study_stability(design(axes), macbeth | synthetic, _print_progress)
    plot_map(grids(axes), {one.config: one for one in results}, FOLDER / "map.png", force=True)
    return [row | {"technique": technique(row)} for row in (one.record() for one in results)]


def technique(row: dict[str, Any]) -> str:
    """Return the model, with its number of coefficients unless it is fixed."""
    return row["model"] if row["model"] == "sigmoid" else f"{row['model']} {row['coefficients']}"


def cube_sensitivity(name: str) -> dict[str, Any]:
    """Measure the sensitivity of a stored cube, and plot that of the first two."""
    path = CUBES / f"{name}.uplift"
    cube = uplift.load(path)
    atlas = recorded_atlas(cube.data, path) if name == CONSTRAINED else None
    result = sensitivity.study_sensitivity(cube, atlas, 24)
    if name in (PLAIN, CONSTRAINED):
        plot_steepness(cube.data, result.lipschitz, FOLDER / f"steepness-{name}.png", force=True)
    if result.removed:
        plot_locality(result.removed, FOLDER / "locality.png", force=True)
    return result.record()


def atlas_changes(changes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Summarise the changed atlases by kind of change."""
    rows = []
    for title, belongs in CHANGE_KINDS.items():
        kind = [one for one in changes if belongs(one["change"])]
        worst = max(kind, key=lambda one: one["moved"])
        radii = {
            key: None if worst[key] is None else max(one[key] for one in kind) for key in ("rgb_radius", "lab_radius")
        }
        rows.append(
            {
                "change": title,
                "builds": len(kind),
                "moved": sum(one["moved"] for one in kind) / len(kind),
                "most_moved": {"share": worst["moved"], "change": worst["change"]},
                **radii,
                "delta_e": max(one["delta_e_most"] for one in kind),
                "rms": max(one["rms_mean"] for one in kind),
            }
        )
    return rows


def _print_progress(progress: Progress) -> None:
    if progress.done % 20 == 0 or progress.done == progress.total:
        print(f"{progress.done} of {progress.total} builds", file=sys.stderr)


if __name__ == "__main__":
    main()
