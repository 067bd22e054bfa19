"""The formats that cubes are exported in: one row each, and one function.

Packages of others have rows of their own: an entry point in the group
``uplift.exports``, named as the format, is an `Export`.
"""

from dataclasses import dataclass

from uplift.common.extensions import installed


@dataclass(frozen=True)
class Export:
    """A format that cubes are written in.

    Parameters
    ----------
    suffix : str
        Suffix of its files. Of formats with one suffix the first is the default.
    about : str
        What it is, for the help.
    writer : str
        ``"module:function"``, imported when it is used. The function takes a `Cube`, a
        `Path`, the name of the format, ``force``, and the options that are given, and
        returns a line about what it wrote.
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
"""The formats of this package by name."""


def known_exports() -> dict[str, Export]:
    """Return the formats of this package, and those of others, by name."""
    outside = {name: load() for name, load in installed("exports").items()}
    return EXPORTS | {name: outside[name] for name in outside.keys() - EXPORTS.keys()}
