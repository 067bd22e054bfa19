"""Inputs that several commands name alike: atlases, images, wavelengths and RGB spaces.
All raise `UpliftError`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from uplift.common.errors import AtlasError, OptionError, OutputError
from uplift.common.text import format_value, parse_float

from .output.diagnostics import warn
from .startup import hide_drawing_notes

if TYPE_CHECKING:
    from uplift.atlas.atlas import Atlas
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.colour.spaces import ImageSpace
    from uplift.extras.images.picture import Picture

LOCAL = "atlases/*.txt"
DEFAULT_ATLASES = f"{LOCAL} if there are any, or else the shipped atlases"
"""Default of ``--atlas``, as the help states it."""
MAX_WAVELENGTHS = 100_000
MAX_SIDE = 960
"""Pixels of the longer side of an image, as shown and compared."""


def atlas_files(files: Sequence[str | Path]) -> Sequence[str | Path]:
    """Return the files of atlases; without any, the default ones."""
    from uplift.atlas.sources import shipped_atlases

    return (
        files
        or sorted(Path().glob(LOCAL))
        or [shipped.path for shipped in shipped_atlases()]
    )


def read_atlases(files: Sequence[str | Path]) -> dict[str, Atlas]:
    """Return atlases, by default the usual ones, by the stems of their files."""
    from uplift.atlas.sources import read_atlas

    atlases: dict[str, Atlas] = {}
    for file in atlas_files(files):
        name = Path(file).stem
        if name in atlases:
            raise AtlasError(
                f"another atlas has the name '{name}' too",
                path=file,
                hint="rename one of the files",
            )
        atlases[name] = read_atlas(file)
    return atlases


def read_pictures(
    paths: Sequence[str], sensor: Sensor, **options: str | None
) -> list[Picture]:
    """Return images, reduced to `MAX_SIDE`, and emit their warnings."""
    from uplift.extras.images.picture import read_picture

    pictures = [
        read_picture(path, sensor, max_side=MAX_SIDE, **options) for path in paths
    ]
    for picture in pictures:
        warn(picture.warnings)
    return pictures


def parse_wavelengths(text: str) -> Array:
    """Parse '380:780:5' (end included) or '450,550,650' into nm, shape (N,)."""
    import numpy as np

    try:
        if ":" not in text:
            return np.array(list(map(parse_float, text.split(","))))
        start, end, step = map(parse_float, text.split(":"))
        count = int((end - start) / step + 1e-9) + 1
        if 0 < step < math.inf and end >= start and count <= MAX_WAVELENGTHS:
            return start + step * np.arange(count, dtype=float)
    except (ValueError, ZeroDivisionError, OverflowError):
        pass
    raise OptionError(
        f"wavelengths must be START:END:STEP or a list, got {format_value(text)}",
        hint="write for example 380:780:5 or 450,550,650, in nm",
    )


def find_input_space(name: str) -> ImageSpace:
    """Return the space of a name or of chromaticities; tables load in a second."""
    from uplift.extras.colour.spaces import find_space

    return find_space(name)


def find_light(text: str) -> Illuminant:
    """Return the name of an illuminant, or the lamp of a file. Without a file of this
    name no reader is imported.
    """
    from uplift.colorimetry import tables

    if text in tables.names("illuminant") or (
        not os.path.lexists(text) and ":" not in text
    ):
        tables.stated_name("illuminant", text)
        return text
    from uplift.extras.emission import lamps

    return lamps.find_light(text)


def check_page(path: str) -> None:
    """Check the name of a page, which must end in .html."""
    if not path.lower().endswith(".html"):
        raise OutputError(
            "the name of a page must end in .html",
            path=path,
            hint="name the page .html",
        )


def check_figure_page(path: str) -> None:
    """Check the name of a page with figures, which matplotlib draws."""
    from uplift.extras.pages.figure import matplotlib

    matplotlib()
    check_page(path)


def check_plot(path: str) -> None:
    """Check the name of a plot, whose suffix must be that of a figure."""
    from uplift.extras.pages.figure import check_suffix

    hide_drawing_notes()
    check_suffix(path)


def check_range(wavelengths: Array, known: Array) -> None:
    """Check that wavelengths (N,) lie in the range of a cube or a table; the library
    continues spectra.
    """
    first, last = known[[0, -1]]
    for wavelength in wavelengths:
        if not first <= wavelength <= last:
            hint = "stay in this range; 'uplift build --range' sets that of a cube"
            if wavelength < 10:
                hint = f"give nm: {wavelength:g} µm are {1000 * wavelength:g} nm"
            raise OptionError(
                f"wavelengths must lie in {first:g}-{last:g} nm, got {wavelength:g}",
                hint=hint,
            )
