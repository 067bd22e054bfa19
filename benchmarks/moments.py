"""Reconstruction of spectra from moments, compared with Tódová 2020, for
docs/reproductions.md and its pictures.
"""

from collections.abc import Mapping
from functools import partial
from itertools import product, starmap

import numpy as np

import uplift
from benchmarks import DOCS, MACBETH, Row, read_reference, record
from benchmarks.materials import inside, read_atlases
from uplift.atlas import Atlas, merge
from uplift.colorimetry import delta_e_1976, delta_e_spectra, lab, observer
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.scene.representations import samples
from uplift.lab.study.moments import (
    TECHNIQUES,
    MomentsStudy,
    Technique,
    study_moments,
)
from uplift.lab.study.plots import plot_errors, plot_patches, plot_worst
from uplift.models.moments import WARPS

PICTURES = DOCS / "moments"
FLOATS = (3, 5, 9, 13, 16)
COEFFICIENTS = (3, 5, 9)
Pair = tuple[float, float]
"""Mean and largest error."""
Errors = Mapping[tuple[Technique, int], Pair]
"""Mean and largest ΔE76 by technique and number of moments."""


def main() -> None:
    """Measure, draw and store."""
    atlases = read_atlases()
    study = study_moments(atlases)
    thesis = read_thesis()
    counts = range(study.max_moments + 1)
    ours = {key: pairs(study, *key)[0] for key in product(TECHNIQUES, counts)}
    plot(study, thesis)
    record(
        "moments",
        winners=[
            {
                "floats": floats,
                "ours": best(ours, floats),
                "thesis": best(thesis, floats),
            }
            for floats in FLOATS
        ],
        by_moments=[
            {
                "moments": count,
                "ours": with_moments(ours, count),
                "thesis": with_moments(thesis, count),
            }
            for count in counts
        ],
        lights=starmap(partial(under_lights, study), product(FLOATS, TECHNIQUES)),
        warps=starmap(partial(warp_errors, study.measured), product(WARPS, FLOATS)),
        cubes=starmap(partial(cube_errors, atlases), product(COEFFICIENTS, WARPS)),
    )


def plot(study: MomentsStudy, thesis: Errors) -> None:
    """Plot the errors with those of the thesis, and spectra."""
    counts = range(study.max_moments + 1)
    curves = {}
    for technique in TECHNIQUES:
        points = [[technique.floats(n), *thesis[technique, n]] for n in counts]
        curves[technique] = np.array(points)
    both = {f"our {len(study.names)} entries": study.curves(), "Tódová 2020": curves}
    plot_errors(both, PICTURES / "errors.png", force=True)
    plot_patches(study, PICTURES / "patches.png", force=True)
    plot_worst(study, PICTURES / "worst.png", force=True)


def read_thesis() -> dict[tuple[Technique, int], Pair]:
    """Return mean and largest ΔE76 of appendix B.1."""
    by_short = {technique.short: technique for technique in TECHNIQUES}
    errors = {}
    for row in read_reference("moments_todova2020.csv"):
        key = by_short[row["method"]], int(row["moments"])
        errors[key] = float(row["mean"]), float(row["max"])
    return errors


def max_moments(technique: Technique, floats: int) -> int:
    """Return the largest number of moments that fit into ``floats`` numbers."""
    return floats - 1 if technique.mirrored else (floats - 1) // 2


def pairs(study: MomentsStudy, technique: Technique, count: int) -> list[Pair]:
    """Return mean and largest error of every measure."""
    result = study.result(technique, count)
    return list(zip(result.mean, result.max, strict=True))


def with_moments(errors: Errors, count: int) -> dict[str, Pair]:
    """Return the errors of every technique with ``count`` moments."""
    return {technique.short: errors[technique, count] for technique in TECHNIQUES}


def best(errors: Errors, floats: int) -> Row:
    """Return the best techniques by mean and by largest error."""
    winners = {}
    for side, statistic in enumerate(("mean", "max")):
        values = {}
        for technique in TECHNIQUES:
            pair = errors[technique, max_moments(technique, floats)]
            values[technique.short] = pair[side]
        winner = min(values, key=values.__getitem__)
        winners[statistic] = {"technique": winner, "value": values[winner]}
    return winners


def under_lights(study: MomentsStudy, floats: int, technique: Technique) -> Row:
    """Return ΔE00 under each light and the rms difference of the spectra."""
    _, *delta_e, rms = pairs(study, technique, max_moments(technique, floats))
    return {
        "floats": floats,
        "technique": technique.short,
        "errors": dict(zip(REPORT_LIGHTS, delta_e, strict=True)),
        "rms": rms,
    }


def warp_errors(measured: Array, warp: str, floats: int) -> Row:
    """Return ΔE76 under D65 and rms between reflectances (E, 401) and those of their
    mirrored moments.
    """
    technique = Technique(mirrored=True, warped=warp != "none", warp=warp)
    light = observer.light("D65")
    original = measured[:, :: samples.TABLE_STRIDE]
    moments = technique.moments(measured, samples.wavelengths(), floats - 1)
    spectra = technique.reconstruct(moments, observer.grid())
    colours = [lab(values @ light.xyz.T, light.white) for values in (spectra, original)]
    delta_e = delta_e_1976(*colours)
    rms = np.sqrt(((spectra - original) ** 2).mean(axis=1))
    return {
        "warp": warp,
        "floats": floats,
        "mean": delta_e.mean(),
        "max": delta_e.max(),
        "rms": rms.mean(),
    }


def cube_errors(atlases: Mapping[str, Atlas], count: int, warp: str) -> Row:
    """Return mean ΔE00 under each light of a ColorChecker cube at the entries of all
    other atlases.
    """
    cube = uplift.build(
        MACBETH, dim=16, coefficients=count, entry_coefficients=count, warp=warp
    )
    others = inside(merge(atlases[name] for name in atlases if name != "macbeth"))
    answers = cube.reflectance(others.rgb)
    errors = {
        name: delta_e_spectra(observer.light(name), answers, others.measured).mean()
        for name in REPORT_LIGHTS
    }
    return {
        "warp": warp,
        "coefficients": count,
        "spectra": len(answers),
        "errors": errors,
    }
