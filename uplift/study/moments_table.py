"""The results of the moments study as plain values: records for JSON, a CSV file."""

from __future__ import annotations

import csv
import io
import os
from typing import Any

from uplift.files import write_text
from uplift.study.moments import MEASURES, Result, Study


def records(study: Study) -> list[dict[str, Any]]:
    """A flat record for every group, technique and count; ``<measure>_mean`` and ``_max`` for every measure."""
    return [_record(study, result) for result in study.results()]


def csv_text(study: Study) -> str:
    """The records as CSV, a line each."""
    out = io.StringIO()
    rows = records(study)
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def write_csv(study: Study, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write the records as CSV. Raises `OutputError`."""
    write_text(csv_text(study), path, force=force)


def _record(study: Study, result: Result) -> dict[str, Any]:
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
