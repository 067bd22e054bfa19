"""Atlases of measured reflectances: readers of many formats, writers of two, and
resampling.
"""

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source, merge
from uplift.atlas.formats import FORMATS, Format
from uplift.atlas.resample import Clip, Resampled, on_grid, resample
from uplift.atlas.sources import (
    ShippedAtlas,
    from_distributions,
    read_atlas,
    shipped_atlases,
    write_atlas,
)

__all__ = [
    "FORMATS",
    "Atlas",
    "Clip",
    "Entry",
    "Format",
    "Header",
    "Resampled",
    "ShippedAtlas",
    "SkippedEntry",
    "Source",
    "from_distributions",
    "merge",
    "on_grid",
    "read_atlas",
    "resample",
    "shipped_atlases",
    "write_atlas",
]
