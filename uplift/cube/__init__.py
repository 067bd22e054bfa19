"""The cube file and what is exported from it. Needs numpy and the file's own library, nothing of the fit."""

from __future__ import annotations

from uplift.cube.data import AtlasTable, CubeData
from uplift.cube.file import contents, digest, read, write
from uplift.cube.sheet_file import check_sheet, write_sheet
from uplift.cube.slices import check_slices, write_slices

__all__ = [
    "AtlasTable",
    "CubeData",
    "check_sheet",
    "check_slices",
    "contents",
    "digest",
    "read",
    "write",
    "write_sheet",
    "write_slices",
]
