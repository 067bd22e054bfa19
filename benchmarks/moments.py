"""Reconstruction of spectra from moments, compared with Tódová 2020, for
docs/reproductions.md and its pictures.
"""

from itertools import product

import uplift
from benchmarks import DOCS, MACBETH, Row, read_reference
from benchmarks.materials import inside, read_atlases
from uplift.atlas import merge
from uplift.colorimetry import delta_e_spectra, observer
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.lab.study.moments import (
    ALL_ATLASES,
    TECHNIQUES,
    MomentsStudy,
    Technique,
    study_moments,
)
from uplift.lab.study.plots import plot_errors, plot_patches, plot_worst
from uplift.models.moments import WARPS

PICTURES = DOCS / "moments"
COLOUR = Technique(mirrored=True, warp="colour")
"""A technique that the thesis does not have."""
COEFFICIENTS = (3, 5, 9)


def errors() -> list[Row]:
    """Measure all entries; plot spectra, and the errors with those of the thesis."""
    study = study_moments(read_atlases(), techniques=(*TECHNIQUES, COLOUR))
    rows = with_thesis(study)
    printed = [row for row in rows if row["thesis_mean"] is not None]
    columns = {"delta_e_76_D65_mean": "thesis_mean", "delta_e_76_D65_max": "thesis_max"}
    thesis = [row | {name: row[of] for name, of in columns.items()} for row in printed]
    both = {f"our {len(study.names)} entries": printed, "Tódová 2020": thesis}
    plot_errors(both, PICTURES / "errors.png", force=True)
    plot_patches(study, PICTURES / "patches.png", force=True)
    plot_worst(study, PICTURES / "worst.png", force=True)
    return rows


def with_thesis(study: MomentsStudy) -> list[Row]:
    """Return the errors of all atlases together, and those of appendix B.1."""
    printed = {}
    for row in read_reference("moments_todova2020.csv"):
        means = {"thesis_mean": float(row["mean"]), "thesis_max": float(row["max"])}
        printed[row["method"], int(row["moments"])] = means
    rows = [row for row in study.rows() if row["atlas"] == ALL_ATLASES]
    cases = product(study.techniques, range(len(rows) // len(study.techniques)))
    found = []
    for (technique, count), row in zip(cases, rows, strict=True):
        names = {"technique": technique.short, "warp": technique.warp}
        of_thesis = {"thesis_mean": None, "thesis_max": None}
        if technique in TECHNIQUES:
            of_thesis = printed[technique.short, count]
        found.append({**names, **row, **of_thesis})
    return found


def cubes() -> list[Row]:
    """Return mean ΔE00 under each light of ColorChecker cubes at the entries of all
    other atlases.
    """
    atlases = read_atlases()
    del atlases["macbeth"]
    others = inside(merge(atlases.values()))
    rows = []
    for count, warp in product(COEFFICIENTS, WARPS):
        cube = uplift.build(
            MACBETH, dim=16, coefficients=count, entry_coefficients=count, warp=warp
        )
        answers = cube.reflectance(others.rgb)
        for name in REPORT_LIGHTS:
            found = delta_e_spectra(observer.light(name), answers, others.measured)
            head = {"coefficients": count, "warp": warp, "light": name}
            rows.append({**head, "n": len(found), "mean": found.mean()})
    return rows


QUESTIONS = {"errors": errors, "cubes": cubes}
