"""Results of the moments study as records for JSON and CSV."""

from __future__ import annotations

from typing import Any

from uplift.lab.study.moments import MEASURES, MomentsResult, MomentsStudy


def records(study: MomentsStudy) -> list[dict[str, Any]]:
    """Make a flat record for every group, technique and count, with the mean and maximum of every measure."""
    return [_record(study, result) for result in study.results()]


def _record(study: MomentsStudy, result: MomentsResult) -> dict[str, Any]:
    errors: dict[str, float] = {}
    for name, mean, largest in zip(MEASURES, result.mean, result.max, strict=True):
        errors |= {f"{name}_mean": float(mean), f"{name}_max": float(largest)}
    return {
        "atlas": result.group,
        "entries": len(study.rows(result.group)),
        "mirrored": result.technique.mirrored,
        "warped": result.technique.warped,
        "moments": result.moments,
        "floats": result.floats,
        **errors,
        "worst": study.names[result.worst],
    }
