"""The content of a cube and of an emission table, and the files that store them."""

from __future__ import annotations

from uplift.cube.data import AtlasTable, CubeData, EntrySpectra, LeftOut
from uplift.cube.emission import (
    EmissionData,
    emission_digest,
    is_emission_table,
    read_emission,
    write_emission,
)
from uplift.cube.file import contents, digest, read, write

__all__ = [
    "AtlasTable",
    "CubeData",
    "EmissionData",
    "EntrySpectra",
    "LeftOut",
    "contents",
    "digest",
    "emission_digest",
    "is_emission_table",
    "read",
    "read_emission",
    "write",
    "write_emission",
]
