"""Reconstruction of spectra from moments, compared with Tódová 2020, for docs/moments.md and its pictures."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, read_reference, record
from uplift.colorimetry.lights import REPORT_LIGHTS
from uplift.lab.study.moments import TECHNIQUES, MomentsResult, MomentsStudy, Technique, study_moments
from uplift.lab.study.moments_plots import Curve, curves, plot_errors, plot_patches, plot_worst

PICTURES = DOCS / "moments"
FLOATS = (3, 5, 9, 13, 16)
DEFAULT_FLOATS = 9
Pair = list[float]
"""Mean and largest error."""
Thesis = Mapping[tuple[Technique, int], Pair]
"""Mean and largest ΔE76 by technique and number of moments."""


def main() -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    atlases = {path.stem: uplift.read_atlas(path) for path in sorted(ATLASES.glob("*.txt"))}
    study, thesis = study_moments(atlases), read_thesis()
    both = {f"our {len(study.names)} entries": curves(study), "Tódová 2020": thesis_curves(thesis)}
    plot_errors(both, PICTURES / "errors.png", force=True)
    plot_patches(study, PICTURES / "patches.png", force=True)
    plot_worst(study, PICTURES / "worst.png", force=True)
    record(
        "moments",
        winners=[winners(study, thesis, floats) for floats in FLOATS],
        by_moments=[by_moments(study, thesis, count) for count in range(study.max_moments + 1)],
        lights=[under_lights(study, floats, one) for floats in FLOATS for one in TECHNIQUES],
        by_atlas=[by_atlas(study, group) for group in study.groups],
        worst=[worst_entries(study, floats) for floats in FLOATS],
    )


def read_thesis() -> Thesis:
    """Return mean and largest ΔE76 of appendix B.1."""
    by_short = {technique.short: technique for technique in TECHNIQUES}
    rows = read_reference("moments_todova2020.csv")
    return {(by_short[row["method"]], int(row["moments"])): [float(row["mean"]), float(row["max"])] for row in rows}


def thesis_curves(thesis: Thesis) -> dict[Technique, Curve]:
    """Return the figures of the thesis as curves."""
    result = {}
    for technique in TECHNIQUES:
        counts = sorted(count for one, count in thesis if one == technique)
        points = [(technique.floats(count), *thesis[technique, count]) for count in counts]
        result[technique] = Curve(*np.array(points, dtype=float).T)
    return result


def max_moments(technique: Technique, floats: int) -> int:
    """Return the largest number of moments that fit into ``floats`` numbers."""
    return floats - 1 if technique.mirrored else (floats - 1) // 2


def pair(result: MomentsResult, measure: int = 0) -> Pair:
    """Return the mean and the largest error."""
    return [float(result.mean[measure]), float(result.max[measure])]


def winners(study: MomentsStudy, thesis: Thesis, floats: int) -> dict[str, Any]:
    """Return the best technique by mean and by largest error, here and in the thesis."""

    def best(errors: Callable[[Technique, int], Pair], side: int) -> dict[str, Any]:
        values = {one: errors(one, max_moments(one, floats))[side] for one in TECHNIQUES}
        technique = min(values, key=values.__getitem__)
        return {"technique": technique.short, "value": values[technique]}

    sources = {
        "ours": lambda technique, count: pair(study.result(technique, count)),
        "thesis": lambda technique, count: thesis[technique, count],
    }
    both = {name: {"mean": best(errors, 0), "max": best(errors, 1)} for name, errors in sources.items()}
    return {"floats": floats, **both}


def by_moments(study: MomentsStudy, thesis: Thesis, count: int) -> dict[str, Any]:
    """Return the errors of every technique with ``count`` moments, here and in the thesis."""
    return {
        "moments": count,
        "ours": {one.short: pair(study.result(one, count)) for one in TECHNIQUES},
        "thesis": {one.short: thesis[one, count] for one in TECHNIQUES},
    }


def under_lights(study: MomentsStudy, floats: int, technique: Technique) -> dict[str, Any]:
    """Return ΔE00 under each light and the rms difference of the spectra."""
    result = study.result(technique, max_moments(technique, floats))
    errors = {light: pair(result, 1 + row) for row, light in enumerate(REPORT_LIGHTS)}
    return {"floats": floats, "technique": technique.short, "errors": errors, "rms": pair(result, -1)}


def by_atlas(study: MomentsStudy, group: str) -> dict[str, Any]:
    """Return the errors of an atlas with the default number of floats."""
    errors = {one.short: pair(study.result(one, max_moments(one, DEFAULT_FLOATS), group)) for one in TECHNIQUES}
    return {"atlas": group, "entries": len(study.rows(group)), "errors": errors}


def worst_entries(study: MomentsStudy, floats: int) -> dict[str, Any]:
    """Return the entry with the largest ΔE76 of each technique."""
    worst = {}
    for technique in TECHNIQUES:
        result = study.result(technique, max_moments(technique, floats))
        entry = {"name": study.names[result.worst], "atlas": study.atlases[result.worst]}
        worst[technique.short] = entry | {"error": float(result.max[0])}
    return {"floats": floats, "worst": worst}


if __name__ == "__main__":
    main()
