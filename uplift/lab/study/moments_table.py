"""The results of the moments study as plain values: records for JSON and CSV."""

from __future__ import annotations

from typing import Any

from uplift.lab.study.moments import MEASURES, MomentsResult, MomentsStudy


def records(study: MomentsStudy) -> list[dict[str, Any]]:
    """A flat record for every group, technique and count; ``<measure>_mean`` and ``_max`` for every measure."""
    return [_record(study, result) for result in study.results()]


def _record(study: MomentsStudy, result: MomentsResult) -> dict[str, Any]:
    errors: dict[str, float] = {}
    for name, mean, most in zip(MEASURES, result.mean, result.most, strict=True):
        errors |= {f"{name}_mean": float(mean), f"{name}_max": float(most)}
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
