"""Failures of fits, sensitivity of stored cubes, and exported programs, for
docs/stability.md and its pictures.
"""

from itertools import product
from operator import itemgetter

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, MACBETH, Row, record, show
from benchmarks.performance import CHECKED, MODES, run_header
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.report.rebuild import recorded_atlas
from uplift.lab.chart.selection import perturb_method, select_methods
from uplift.lab.study.plots import plot_locality, plot_map
from uplift.lab.study.sensitivity import (
    COLOURS,
    MOVED_DELTA_E,
    NOISE,
    perturb,
    study_sensitivity,
)
from uplift.lab.study.stability import (
    NO_ATLAS,
    SYNTHETIC_ATLASES,
    DesignSpace,
    study_stability,
)
from uplift.lookup import Cube

FOLDER = DOCS / "stability"
PLAIN = "moments-16"
CONSTRAINED = "moments-16-macbeth"
STORED = (
    PLAIN,
    CONSTRAINED,
    "sigmoid-16",
    "sigmoid-16-macbeth",
    "moments-8",
    "sigmoid-8",
)
"""Stored cubes. The page lists the first two; the atlas of the second is changed."""
ENTRIES = 24
PUBLISHED = ("otsu2018", "mallett2019", "smits1999")
KINDS = {
    f"noise of {NOISE:g} on all entries": "noise",
    "one entry reversed in wavelength": " wrong",
    "one entry left out": " left out",
}
"""Kinds of changed atlases by a part of their descriptions."""
EXPORT_DIM = 12
VISIBLE = 1e-3
SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB", "ACES2065-1")
EXPORTED = ((9, 9, None), (3, 3, None), (9, 13, MACBETH))
"""Coefficients of nodes and of entries, and the atlas, of exported cubes."""


def main() -> None:
    """Measure, draw and store."""
    FOLDER.mkdir(exist_ok=True)
    published()
    exports()
    cubes = {name: cube_sensitivity(name) for name in STORED}
    record(
        "stability",
        light=NARROW_BAND_LIGHT,
        noise=NOISE,
        moved_delta_e=MOVED_DELTA_E,
        queries=COLOURS,
        plain=PLAIN,
        constrained=CONSTRAINED,
        map=failure_map(),
        cubes=cubes,
        atlas_changes=[
            summary(title, ending, cubes[CONSTRAINED]["changes"])
            for title, ending in KINDS.items()
        ],
    )


def published() -> None:
    """Measure and store how the packaged cube and published methods answer moved
    queries.
    """
    light = observer.light(NARROW_BAND_LIGHT)
    moves = [
        move | {"mode": "packaged cube"}
        for move in perturb(uplift.load(), light)
        if move["mode"] == "spectra"
    ]
    for method in select_methods(PUBLISHED):
        moves += perturb_method(method, light)
    record(
        "stability",
        "stability-published",
        light=NARROW_BAND_LIGHT,
        queries=COLOURS,
        moves=moves,
    )


def failure_map() -> list[Row]:
    """Run the builds of the design, and plot them."""
    atlases = {"macbeth": uplift.read_atlas("macbeth")}
    for name, make in SYNTHETIC_ATLASES.items():
        atlases[name] = make()
    design = DesignSpace(atlases=(NO_ATLAS, *atlases))
    results = study_stability(design.configs(), atlases, show)
    plot_map(list(results.values()), FOLDER / "map.png", force=True)
    return [row | {"technique": config.model_label} for config, row in results.items()]


def cube_sensitivity(name: str) -> Row:
    """Measure the sensitivity of a stored cube, and plot the effect of left out
    entries.
    """
    path = CUBES / f"{name}.uplift"
    cube = uplift.load(path)
    atlas = recorded_atlas(cube.data, path) if name == CONSTRAINED else None
    moves, changes = study_sensitivity(cube, atlas, ENTRIES)
    if changes:
        plot_locality(changes, FOLDER / "locality.png", force=True)
    return {"moves": moves, "changes": [change.record() for change in changes]}


def summary(title: str, phrase: str, changes: list[Row]) -> Row:
    """Summarise the changed atlases whose descriptions have a phrase."""
    kind = [change for change in changes if phrase in change["change"]]
    worst = max(kind, key=itemgetter("moved"))

    def largest(name: str) -> float:
        return max(change[name] for change in kind)

    return {
        "change": title,
        "builds": len(kind),
        "moved": sum(change["moved"] for change in kind) / len(kind),
        "most_moved": {"share": worst["moved"], "change": worst["change"]},
        "lab_radius": None if worst["lab_radius"] is None else largest("lab_radius"),
        "delta_e": largest("delta_e_most"),
        "rms": largest("rms_mean"),
    }


def exports() -> None:
    """Compare exported programs with Python in wide gamuts, and store it."""
    rows = []
    for space, (count, entry_count, atlas) in product(SPACES, EXPORTED):
        cube = uplift.build(
            atlas,
            space=space,
            dim=EXPORT_DIM,
            coefficients=count,
            entry_coefficients=entry_count,
        )
        rgb = realisable(cube)
        rows += [
            {
                "space": space,
                "coefficients": count,
                "entries": entry_count if atlas else None,
                "mode": mode,
                **difference(cube, mode, rgb),
            }
            for mode in MODES
        ]
    record(
        "stability",
        "exports",
        dim=EXPORT_DIM,
        colours=CHECKED,
        visible=VISIBLE,
        rows=rows,
    )


def realisable(cube: Cube) -> Array:
    """Return random colours (CHECKED, 3), float32, inside the solid."""
    rgb = np.random.default_rng(0).uniform(0, 1, (4 * CHECKED, 3)).astype(np.float32)
    outside = cube.data.solid.signed_distance(rgb.astype(float))
    return rgb[outside < -cube.data.threshold][:CHECKED]


def difference(cube: Cube, mode: str, rgb: Array) -> Row:
    """Return the largest and mean difference of the colours' reflectances, and the
    share of visible ones.
    """
    spectra, _ = run_header(cube, mode, rgb, 0)
    error = np.abs(spectra - cube.reflectance(rgb.astype(float), mode=mode)).max(axis=1)
    return {
        "largest": error.max(),
        "mean": error.mean(),
        "visible": (error > VISIBLE).mean(),
    }
