"""The content of a cube, and the file that stores it."""

from uplift.cube.data import AtlasTable, CubeData, EntrySpectra, common_sensor
from uplift.cube.file import contents, digest, read, summarise, write

__all__ = [
    "AtlasTable",
    "CubeData",
    "EntrySpectra",
    "common_sensor",
    "contents",
    "digest",
    "read",
    "summarise",
    "write",
]
