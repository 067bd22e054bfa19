"""Formats of atlas files, and how closely files in the layouts of instruments are read,
for docs/atlas-files.md.
"""

import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks import Row
from tests.atlas.vendor_files import VENDORS, Vendor, sample
from uplift.atlas.atlas import Atlas
from uplift.atlas.formats import known_formats
from uplift.atlas.sources import read_atlas
from uplift.common.errors import UpliftWarning

UPLIFT = "uplift"
"""Library of the formats that uplift parses itself."""


def largest_difference(vendor: Vendor, atlas: Atlas) -> float:
    """Return the largest difference between written values and those that are read."""
    with tempfile.TemporaryDirectory() as folder:
        path = vendor.save(atlas[: vendor.count], Path(folder))
        # Columns of other quantities cause warnings.
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            entries = read_atlas(path)
    return max(
        np.abs(entry.values - expected.values).max()
        for entry, expected in zip(entries, atlas, strict=False)
    )


def layouts() -> Iterator[Row]:
    """Yield the formats, with the number of layouts and the largest difference."""
    atlas = sample(read_atlas("macbeth"))
    differences: dict[str, list[float]] = {}
    for vendor in VENDORS:
        of_format = differences.setdefault(vendor.format, [])
        of_format.append(largest_difference(vendor, atlas))
    for file_format in known_formats():
        read = differences.get(file_format.name, [])
        yield {
            "name": file_format.name,
            "suffixes": ", ".join(file_format.suffixes),
            "written": file_format.written,
            "library": file_format.library or UPLIFT,
            "extra": file_format.extra,
            "layouts": len(read) or "the shipped atlases",
            "difference": max(read, default=None),
        }


def programs() -> list[Row]:
    """Return the programs whose layouts are read."""
    return [
        {"program": vendor.program, "format": vendor.format, "sample": vendor.template}
        for vendor in VENDORS
    ]


QUESTIONS = {"layouts": layouts, "programs": programs}
