"""Atlases of measured reflectances: readers of many formats, writers of two, and
resampling.
"""

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source, merge
from uplift.atlas.formats import Format, known_formats
from uplift.atlas.resample import Clip, Resampled, on_grid, resample
from uplift.atlas.sources import (
    ShippedAtlas,
    from_distributions,
    read_atlas,
    shipped_atlases,
    write_atlas,
)

__all__ = [
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
    "known_formats",
    "merge",
    "on_grid",
    "read_atlas",
    "resample",
    "shipped_atlases",
    "write_atlas",
]
