"""The contact sheet as a file: OpenEXR for colour work, PNG for a look."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.srgb import encode
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write, check_output
from uplift.cube.data import CubeData
from uplift.io.slices import exr
from uplift.viz.sheet.sheet import Label, compose

INK = 0.75
"""Linear grey of the text."""
DPI = 64
"""A power of two: dividing pixels by it is exact, so that the text's canvas is as large as the sheet."""
STYLE: dict[str, Any] = {
    "family": "DejaVu Sans",  # comes with matplotlib
    "va": "center_baseline",
    "usetex": False,
    "parse_math": False,
}

Image = NDArray[np.float32]


def write_sheet(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write the contact sheet of a cube: linear RGB in a single-part ``.exr``, or sRGB in a ``.png``.

    Panels show lattice RGB, fitting distance, status and (with debug information) round; see
    `uplift.viz.sheet.panels` for the colours and `uplift.viz.sheet.sheet.Layout` for the places.

    Raises
    ------
    OutputError : the name ends in neither, exists already (without ``force``) or cannot be written.
    """
    check_sheet(path, force=force)
    sheet = compose(data)
    WRITERS[_suffix(path)](data, _lettered(sheet.image, sheet.labels), Path(path), force)


def check_sheet(path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Raises `OutputError` where `write_sheet` would: asks before long work."""
    if _suffix(path) not in WRITERS:
        raise OutputError("a sheet is OpenEXR or PNG", path=path, hint="name the file .exr or .png")
    check_output(path, force=force)


def _suffix(path: str | os.PathLike[str]) -> str:
    return Path(path).suffix.lower()


def _write_exr(data: CubeData, image: Image, path: Path, force: bool) -> None:
    channels = {letter: image[..., i] for i, letter in enumerate("RGB")}
    exr.write_parts([exr.part("sheet", exr.attributes(data), channels)], path, force=force)


def _write_png(data: CubeData, image: Image, path: Path, force: bool) -> None:
    from matplotlib.image import imsave

    codes = np.rint(255 * encode(image)).astype(np.uint8)
    # Without a name here matplotlib writes its own and its version.
    with atomic_write(path, force=force) as temporary:
        imsave(temporary, codes, format="png", metadata={"Software": "uplift"})


WRITERS = {".exr": _write_exr, ".png": _write_png}


def _lettered(image: Image, labels: tuple[Label, ...]) -> Image:
    """The image (height, width, 3) with its text, drawn by matplotlib's own font."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = image.shape[:2]
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="none")
    for label in labels:
        text = figure.text(label.x / width, 1 - label.y / height, label.text, **STYLE)
        text.set_fontsize(label.size * 72 / DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    cover = np.asarray(canvas.buffer_rgba())[..., 3:] / np.float32(255)
    return image + cover * (np.float32(INK) - image)
