"""The arrays and the metadata of a cube file: types, shapes and ranges
(docs/cube-file.md).
"""

from uplift.cube.container import RANGE, Stored
from uplift.lattice.point_table import Status

MIN_THRESHOLD = 1e-12
"""Linear RGB. Smaller distances are lost in the rounding of double precision."""
MAX_THRESHOLD = 0.1
"""Linear RGB."""
MAX_LIGHTS = 64
MAX_FILES = 10_000


SINGLE = ("float32",)
POINTS = {
    "coefficients": Stored("n C", ("float32", "float64")),
    "rgb": Stored("n 3", SINGLE),
    "distance": Stored("n", SINGLE, 0),
    "status": Stored("n", ("uint8",), 0, Status.UNREALISABLE),
    "entry": Stored("n", ("int32",), -1),
    "round": Stored("n", ("int16",), feature="debug"),
    "standard_error": Stored("n", SINGLE, 0, feature="errors"),
}
"""Arrays of the `PointTable`. Sparse files have rows of the present nodes only."""
SENSOR = {
    "wavelengths": Stored("N", low=RANGE[0], high=RANGE[1]),
    "cmfs": Stored("N 3"),
    "power": Stored("N", low=0),
    "xyz_to_rgb": Stored("3 3"),
    "decoding": Stored("256"),
    "sensitivities": Stored("N 3", low=0, feature="camera"),
}
ENTRY_COEFFICIENTS = "entry_coefficients"
TABLE = {
    "rgb": Stored("E 3", low=0, high=1),
    "coefficients": Stored("E C"),
    "reach": Stored("E", low=0, high=1),
    "error": Stored("E", low=0),
    ENTRY_COEFFICIENTS: Stored("E K"),
}
"""Arrays of an `AtlasTable`: entries in the RGB space, and those outside it, whose
colours are not in [0, 1].
"""
OUTSIDE = {
    name: stored._replace(shape=f"O{stored.shape[1:]}", feature="outside")
    for name, stored in TABLE.items()
}
OUTSIDE["rgb"] = Stored("O 3", feature="outside")
FAMILIES = {
    "rgb": Stored("F 3", low=0, high=1, feature="families"),
    "family": Stored("F", ("uint8",), feature="families"),
    "measured": Stored("F N", SINGLE, 0, 1, feature="families"),
    "predicted": Stored("F N", SINGLE, 0, 1, feature="families"),
}
"""Arrays of the `LeftOut` families."""
ARRAYS = {
    "nodes": Stored("D", low=0, high=1),
    "points": Stored("n", ("uint32",), feature="sparse"),
    **POINTS,
    **{f"sensor.{name}": stored for name, stored in SENSOR.items()},
    **{f"atlas.{name}": stored for name, stored in TABLE.items()},
    **{f"outside.{name}": stored for name, stored in OUTSIDE.items()},
    "atlas.measured": Stored("M N", SINGLE, 0, 1, feature="left-out"),
    "atlas.left_out": Stored("M N", SINGLE, 0, 1, feature="left-out"),
    "outside.measured": Stored("O N", SINGLE, 0, 1, feature="outside-measured"),
    **{f"families.{name}": stored for name, stored in FAMILIES.items()},
}
"""All arrays of a file by name. Letters as in docs/cube-file.md, and D for the number
of nodes along an axis.
"""

NUMBER = (-1e30, 1e30)
POSITIVE = (0, 1e30)
ENTRIES = [str, 1_000_000]
RGB = [NUMBER, 3]
FILE = {"name": str, "digest": str}
LIGHT = {
    "light": str,
    "wish": RGB,
    "answer": RGB,
    "delta_e": POSITIVE,
    "possible": POSITIVE,
}
PROVENANCE = {
    "uplift?": str,
    # Others are checked where a build is repeated.
    "options?": {"shortest?": NUMBER, "longest?": NUMBER, "*": None},
    "atlases?": [{**FILE, "measured?": str, "missing?": str}, MAX_FILES],
    "libraries?": [FILE, MAX_FILES],
    "families?": [{"name": str, "relevance": NUMBER}, MAX_FILES],
    "looks?": [
        {"name": str, "rgb": RGB, "weight": (0, 1), "lights": [LIGHT, MAX_LIGHTS]},
        MAX_FILES,
    ],
    "left_out?": ENTRIES,
    "left_out_families?": [str, 256],
    "skipped?": ENTRIES,
    "prior?": {
        "length?": POSITIVE,
        "nugget?": POSITIVE,
        "noise?": POSITIVE,
        "error_bound?": POSITIVE,
        "*": None,
    },
    "improvements?": [{"step": str, "tried": int, "mended": int}, MAX_FILES],
    "scene?": [{"*": None}, MAX_FILES],
    "filled?": {"points": int, "cube": str},
    "*": None,
}
MODEL = {
    "name": str,
    "count?": int,
    "phase?": {"start": NUMBER, "end": NUMBER, "warp": str},
    "start?": NUMBER,
    "end?": NUMBER,
}
METADATA = {
    "format": str,
    "version": int,
    "features": [str, 100],
    "model": MODEL,
    "entry_model": MODEL,
    "dim": int,
    "space": str,
    "illuminant": str,
    "observer": str,
    "threshold": (MIN_THRESHOLD, MAX_THRESHOLD),
    "reference": str,
    "entries": ENTRIES,
    "provenance": PROVENANCE,
}
"""The schema of the metadata, by `check_metadata`."""
