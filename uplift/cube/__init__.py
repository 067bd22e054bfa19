"""The cube file and what is exported from it. Needs numpy and the file's own library, nothing of the fit."""

from __future__ import annotations

from uplift.cube.data import AtlasTable, CubeData
from uplift.cube.file import digest, read, write

__all__ = ["AtlasTable", "CubeData", "digest", "read", "write"]
