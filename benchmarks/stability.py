"""Failures of fits, and sensitivity of cubes to queries and atlases, for
docs/stability.md and its pictures.
"""

import uplift
from benchmarks import CUBES, DOCS, Row, show
from uplift.colorimetry import observer
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.report.rebuild import recorded_atlas
from uplift.lab.chart.selection import perturb_method, select_methods
from uplift.lab.study.plots import plot_locality, plot_map
from uplift.lab.study.sensitivity import perturb, perturb_atlas
from uplift.lab.study.stability import DESIGN, study_stability, synthetic_atlases

FOLDER = DOCS / "stability"
CONSTRAINED = "moments-16-macbeth"
"""Stored cube whose atlas is changed."""
STORED = ("moments-16", CONSTRAINED, "sigmoid-16", "sigmoid-16-macbeth")
PUBLISHED = ("otsu2018", "mallett2019", "smits1999")
ENTRIES = 24


def builds() -> list[Row]:
    """Run the builds of the design, and plot them."""
    atlases = {"macbeth": uplift.read_atlas("macbeth"), **synthetic_atlases()}
    configs = DESIGN.with_atlases(atlases).configs()
    rows = study_stability(configs, atlases, show)
    plot_map(rows, FOLDER / "map.png", force=True)
    return rows


def moves() -> list[Row]:
    """Perturb the queries of stored cubes and of published methods."""
    light = observer.light(NARROW_BAND_LIGHT)
    rows = []
    for name in STORED:
        cube = uplift.load(CUBES / f"{name}.uplift")
        rows += [{"method": name, **row} for row in perturb(cube)]
    for method in select_methods(PUBLISHED):
        of_method = perturb_method(method, light)
        rows += [{"method": row["mode"], **row, "mode": None} for row in of_method]
    return rows


def changes() -> list[Row]:
    """Rebuild a stored cube with changed atlases, and plot the effect of entries that
    are left out.
    """
    path = CUBES / f"{CONSTRAINED}.uplift"
    data = uplift.load(path).data
    found = perturb_atlas(data, recorded_atlas(data, path), ENTRIES, show)
    plot_locality(found, FOLDER / "locality.png", force=True)
    return [change.row() for change in found]


QUESTIONS = {"builds": builds, "moves": moves, "changes": changes}
