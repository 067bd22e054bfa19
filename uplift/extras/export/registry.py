"""The formats that cubes and paints are exported in: one row each, and one function.

Packages of others have rows of their own: an entry point in the group
``uplift.exports``, named as the format, is an `Export` of cubes.
"""

from dataclasses import dataclass

from uplift.common.extensions import installed


@dataclass(frozen=True)
class Export:
    """A format that cubes or paints are written in.

    Parameters
    ----------
    suffix : str
        Suffix of its files. Of formats with one suffix the first is the default.
    about : str
        What it is, for the help.
    writer : str
        ``"module:function"``, imported when it is used. The function takes a `Cube`, or
        `Paints`, a `Path`, the name of the format, ``force``, and the options that are
        given, and returns a line about what it wrote.
    options : tuple of str
        Options of ``uplift export`` that it takes, of ``res``, ``light``, ``adapt``,
        ``mode`` and ``table``.
    """

    suffix: str
    about: str
    writer: str
    options: tuple[str, ...] = ()


ROOM = "uplift.extras.export"
PROGRAM = ("program that looks up colours", f"{ROOM}.program:export", ("mode", "table"))
SOURCE = "the same as source in C++, for pbrt-v4 and LuisaRender"
SIGMOIDS = f"{ROOM}.coeff:export"
LUT = (
    "table of the colours under a light, for grading and compositing",
    f"{ROOM}.lut:export",
    ("res", "light", "adapt"),
)
MIXER = (
    "mixer of RGB colours as paints, for painting programs",
    "uplift.extras.paint.mixer_programs:export",
    ("res",),
)

EXPORTS = {
    "c": Export(".h", *PROGRAM),
    "cuda": Export(".cuh", *PROGRAM),
    "glsl": Export(".glsl", *PROGRAM),
    "hlsl": Export(".hlsl", *PROGRAM),
    "coeff": Export(
        ".coeff",
        "table of rgb2spec, for Mitsuba and colour-science",
        SIGMOIDS,
        ("res",),
    ),
    "pbrt": Export(".cpp", SOURCE, SIGMOIDS),
    "luisa": Export(".cpp", SOURCE, SIGMOIDS),
    "cube": Export(".cube", *LUT),
    "clf": Export(".clf", *LUT),
    "film": Export(
        ".npy",
        "table of a spectrum per chromaticity, for film simulation; "
        "with a light, as light that reaches the film",
        f"{ROOM}.film:export",
        ("res", "light"),
    ),
    "mixer-c": Export(".h", *MIXER),
    "mixer-glsl": Export(".glsl", *MIXER),
    "mixer-js": Export(".mjs", *MIXER),
    "html": Export(
        ".html",
        "page that relights images in a browser",
        "uplift.extras.report.live_page:export",
    ),
    "npz": Export(
        ".npz", "all arrays of the cube, for numpy", f"{ROOM}.arrays:export_npz"
    ),
}
"""The formats of this package for cubes, by name."""
LIGHT_PROGRAM = (
    "program that looks up colours of lights",
    f"{ROOM}.light_program:export",
    ("table",),
)
LIGHT_EXPORTS = {
    "c": Export(".h", *LIGHT_PROGRAM),
    "glsl": Export(".glsl", *LIGHT_PROGRAM),
}
"""The formats for emission tables, by name."""
HEADER = ("reader of cube files, in C and C++", f"{ROOM}.runtime:export")
MODULE = ("reader of cube files, in JavaScript", f"{ROOM}.module:export")
RUNTIMES = {
    "h": Export(".h", *HEADER),
    "hpp": Export(".hpp", *HEADER),
    "hh": Export(".hh", *HEADER),
    "js": Export(".js", *MODULE),
    "mjs": Export(".mjs", *MODULE),
}
"""What reads cube files when a program runs, by suffix."""
PAINT_ROOM = "uplift.extras.paint.paint_exports"
PAINT_PROGRAM = (
    "program that mixes the paints at a few wavelengths",
    f"{PAINT_ROOM}:export_program",
)
PAINT_EXPORTS = {
    "c": Export(".h", *PAINT_PROGRAM),
    "glsl": Export(".glsl", *PAINT_PROGRAM),
    "hlsl": Export(".hlsl", *PAINT_PROGRAM),
    "cube": Export(
        ".cube", "table of two paints on grey grounds", f"{PAINT_ROOM}:export_lut"
    ),
    "html": Export(".html", "page that mixes the paints", f"{PAINT_ROOM}:export_page"),
}
"""The formats for paints, by name."""


def known_exports() -> dict[str, Export]:
    """Return the formats for cubes of this package, and those of others, by name."""
    outside = {name: load() for name, load in installed("exports").items()}
    return EXPORTS | {name: outside[name] for name in outside.keys() - EXPORTS.keys()}
