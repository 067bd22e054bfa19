"""Reconstruction of spectra from moments, compared with Tódová 2020, for
docs/reproductions.md and its pictures.
"""

from collections.abc import Mapping

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, MACBETH, Row, read_reference, record
from benchmarks.materials import inside
from uplift.atlas import Atlas, merge
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_1976, delta_e_spectra, lab
from uplift.colorimetry.lights import REPORT_LIGHTS
from uplift.common.arrays import Array
from uplift.extras.scene.representations import samples
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
FLOATS = (3, 5, 9, 13, 16)
CUBE_DIM = 16
COEFFICIENTS = (3, 5, 9)
Pair = list[float]
"""Mean and largest error."""
Errors = Mapping[tuple[Technique, int], Pair]
"""Mean and largest ΔE76 by technique and number of moments."""


def main() -> None:
    """Measure, draw and store."""
    atlases = {
        path.stem: uplift.read_atlas(path) for path in sorted(ATLASES.glob("*.txt"))
    }
    study = study_moments(atlases)
    thesis = read_thesis()
    counts = range(study.max_moments + 1)
    ours = {
        (one, count): pairs(study, one, count)[0]
        for one in TECHNIQUES
        for count in counts
    }
    printed = {
        one: np.array(
            [[one.floats(count), *thesis[one, count]] for count in counts], dtype=float
        )
        for one in TECHNIQUES
    }
    both = {f"our {len(study.names)} entries": study.curves(), "Tódová 2020": printed}
    plot_errors(both, PICTURES / "errors.png", force=True)
    plot_patches(study, PICTURES / "patches.png", force=True)
    plot_worst(study, PICTURES / "worst.png", force=True)
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
        lights=[
            under_lights(study, floats, one) for floats in FLOATS for one in TECHNIQUES
        ],
        warps=[
            warp_errors(study.measured, name, floats)
            for name in WARPS
            for floats in FLOATS
        ],
        cubes=[
            cube_errors(atlases, name, count)
            for count in COEFFICIENTS
            for name in WARPS
        ],
    )


def read_thesis() -> dict[tuple[Technique, int], Pair]:
    """Return mean and largest ΔE76 of appendix B.1."""
    by_short = {technique.short: technique for technique in TECHNIQUES}
    rows = read_reference("moments_todova2020.csv")
    return {
        (by_short[row["method"]], int(row["moments"])): [
            float(row["mean"]),
            float(row["max"]),
        ]
        for row in rows
    }


def max_moments(technique: Technique, floats: int) -> int:
    """Return the largest number of moments that fit into ``floats`` numbers."""
    return floats - 1 if technique.mirrored else (floats - 1) // 2


def pairs(
    study: MomentsStudy, technique: Technique, count: int, group: str = ALL_ATLASES
) -> list[Pair]:
    """Return mean and largest error of every measure."""
    result = study.result(technique, count, group)
    return [
        [float(mean), float(largest)]
        for mean, largest in zip(result.mean, result.max, strict=True)
    ]


def with_moments(errors: Errors, count: int) -> dict[str, Pair]:
    """Return the errors of every technique with ``count`` moments."""
    return {one.short: errors[one, count] for one in TECHNIQUES}


def best(errors: Errors, floats: int) -> Row:
    """Return the best techniques by mean and by largest error."""
    found = {one: errors[one, max_moments(one, floats)] for one in TECHNIQUES}
    rows = []
    for side in (0, 1):
        values = {one.short: pair[side] for one, pair in found.items()}
        winner = min(values, key=values.__getitem__)
        rows.append({"technique": winner, "value": values[winner]})
    return {"mean": rows[0], "max": rows[1]}


def under_lights(study: MomentsStudy, floats: int, technique: Technique) -> Row:
    """Return ΔE00 under each light and the rms difference of the spectra."""
    _, *delta_e, rms = pairs(study, technique, max_moments(technique, floats))
    errors = dict(zip(REPORT_LIGHTS, delta_e, strict=True))
    return {
        "floats": floats,
        "technique": technique.short,
        "errors": errors,
        "rms": rms,
    }


def warp_errors(measured: Array, warp: str, floats: int) -> Row:
    """Return ΔE76 under D65 and the rms difference of reflectances (E, 401) from those
    of their mirrored moments.
    """
    technique = Technique(mirrored=True, warped=warp != "none", warp=warp)
    light = observer.light("D65")
    original = measured[:, :: samples.TABLE_STRIDE]
    spectra = technique.reconstruct(
        technique.moments(measured, samples.wavelengths(), floats - 1), observer.grid()
    )
    delta_e = delta_e_1976(
        *(lab(each @ light.xyz.T, light.white) for each in (spectra, original))
    )
    rms = np.sqrt(((spectra - original) ** 2).mean(axis=1))
    return {
        "warp": warp,
        "floats": floats,
        "mean": delta_e.mean(),
        "max": delta_e.max(),
        "rms": rms.mean(),
    }


def cube_errors(atlases: Mapping[str, Atlas], warp: str, count: int) -> Row:
    """Return mean ΔE00 under each light of a ColorChecker cube, at the entries of all
    other atlases in sRGB.
    """
    cube = uplift.build(
        MACBETH, dim=CUBE_DIM, coefficients=count, entry_coefficients=count, warp=warp
    )
    others = inside(merge(each for name, each in atlases.items() if name != "macbeth"))
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
