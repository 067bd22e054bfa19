"""Reconstruction of spectra from moments, compared with Tódová 2020, for
docs/reproductions.md and its pictures.
"""

from itertools import product

import numpy as np

from benchmarks import DOCS, MACBETH, Row, with_printed
from benchmarks.materials import SENSOR, inside, read_atlases
from uplift.atlas.atlas import merge
from uplift.atlas.sources import read_atlas
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import Task, measure, named_lights
from uplift.lab.study.moments import (
    ALL_ATLASES,
    TECHNIQUES,
    Technique,
    study_moments,
)
from uplift.lab.study.plots import plot_errors, plot_patches, plot_worst
from uplift.models.moments import WARPS

PICTURES = DOCS / "moments"
METHODS = {technique.short: technique for technique in TECHNIQUES} | {
    "M, colour": Technique(mirrored=True, warp="colour")
}
"""Techniques of the thesis by their names in it, and another one."""
COEFFICIENTS = (3, 5, 9)


def errors() -> list[Row]:
    """Measure all entries, next to the errors of appendix B.1, and draw spectra and
    both.
    """
    study = study_moments(read_atlases(), techniques=tuple(METHODS.values()))
    of_all = [row for row in study.rows() if row["atlas"] == ALL_ATLASES]
    counts = len(of_all) // len(METHODS)
    names = np.repeat(list(METHODS), counts).tolist()
    named = [{"method": name, **row} for name, row in zip(names, of_all, strict=True)]
    table = "moments_todova2020.csv"
    rows = with_printed(named, table, ("method", "moments"), mean=float, max=float)
    printed = [row for row in rows if row["thesis_mean"]]
    columns = {"delta_e_76_D65_mean": "thesis_mean", "delta_e_76_D65_max": "thesis_max"}
    thesis = [dict(row) for row in printed]
    for row in thesis:
        row |= {name: row[of] for name, of in columns.items()}
    both = {f"our {len(study.names)} entries": printed, "Tódová 2020": thesis}
    plot_errors(both, PICTURES / "errors.png", force=True)
    plot_patches(study, PICTURES / "patches.png", force=True)
    plot_worst(study, PICTURES / "worst.png", force=True)
    return rows


def cubes() -> list[Row]:
    """Query ColorChecker cubes for the entries of all other atlases."""
    atlases = read_atlases()
    del atlases["macbeth"]
    measured = inside(merge(atlases.values())).measured
    tasks = [Task(SENSOR, read_atlas(MACBETH), measured)]
    rows: list[Row] = []
    for count, warp in product(COEFFICIENTS, WARPS):
        options = {"coefficients": count, "entry_coefficients": count, "warp": warp}
        methods = {"cube": cube(atlas=True, dim=16, **options)}
        rows += measure(methods, tasks, named_lights(REPORT_LIGHTS), **options)
    return rows


QUESTIONS = {"errors": errors, "cubes": cubes}
