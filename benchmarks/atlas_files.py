"""Formats of atlas files, and how closely files in the layouts of instruments are read,
for docs/atlas-files.md.
"""

import tempfile
import warnings
from pathlib import Path

import numpy as np

from benchmarks import record
from tests.atlas.vendor_files import VENDORS, Vendor, sample
from uplift.atlas import Atlas, known_formats, read_atlas
from uplift.common.errors import UpliftWarning

UPLIFT = "uplift"
"""Library of the formats that uplift parses itself."""


def largest_difference(vendor: Vendor, atlas: Atlas) -> float:
    """Return the largest difference between the values that were written and those that
    are read.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = vendor.save(atlas[: vendor.count], Path(folder))
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore", UpliftWarning
            )  # columns of other quantities
            found = read_atlas(path)
    pairs = zip(found, atlas, strict=False)
    return max(
        float(np.abs(entry.values - expected.values).max()) for entry, expected in pairs
    )


def main() -> None:
    """Measure all layouts."""
    atlas = sample(read_atlas("macbeth"))
    found = {vendor.name: largest_difference(vendor, atlas) for vendor in VENDORS}
    rows = []
    for each in known_formats():
        names = [vendor.name for vendor in VENDORS if vendor.format == each.name]
        largest = max((found[name] for name in names), default=None)
        row = {
            "name": each.name,
            "suffixes": ", ".join(each.suffixes),
            "written": each.written,
        }
        row |= {"library": each.library or UPLIFT, "extra": each.extra}
        rows.append(
            row
            | {"layouts": len(names) or "the shipped atlases", "difference": largest}
        )
    programs = [
        {"program": vendor.program, "format": vendor.format, "sample": vendor.template}
        for vendor in VENDORS
    ]
    record(
        "atlas-files",
        layouts=len(found),
        largest=max(found.values()),
        formats=rows,
        programs=programs,
    )
