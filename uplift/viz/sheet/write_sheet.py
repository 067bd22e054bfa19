"""Contact sheets as files: OpenEXR for colour work, PNG for viewing."""

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
from uplift.viz.figure import figure_text
from uplift.viz.sheet.sheet import Label, compose

TEXT_GREY = 0.75
"""Linear grey of the text."""
DPI = 64
"""A power of two: division is exact, so the canvas of the text has the size of the sheet."""
STYLE: dict[str, Any] = {
    "family": "DejaVu Sans",  # comes with matplotlib
    "va": "center_baseline",
    "usetex": False,
    "parse_math": False,
}

Image = NDArray[np.float32]


def write_sheet(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write the contact sheet of a cube: linear RGB in a single-part ``.exr``, or sRGB in a ``.png``.

    Panels show lattice RGB, fitting distance, status, standard error (of cubes with an atlas) and round (with debug
    information).

    Parameters
    ----------
    data : CubeData
        The cube.
    path : path-like
        File to write.
    force : bool
        Whether to replace an existing file.

    Raises
    ------
    OutputError
        The path ends in neither suffix (code ``unknown-suffix``), cannot be written, or exists and ``force`` is
        off.
    """
    check_sheet(path, force=force)
    sheet = compose(data)
    image = _draw_text(sheet.image, sheet.labels)
    WRITERS[_suffix(path)](image, data, Path(path), force)


def check_sheet(path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Check that `write_sheet` can write a file, before long work.

    Parameters
    ----------
    path : path-like
        File to write.
    force : bool
        Whether an existing file can be replaced.

    Raises
    ------
    OutputError
        As `write_sheet` raises it.
    """
    if _suffix(path) not in WRITERS:
        raise OutputError(
            "the name of a sheet must end in .exr or .png",
            code="unknown-suffix",
            path=path,
            hint="name the file .exr or .png",
        )
    check_output(path, force=force)


def _suffix(path: str | os.PathLike[str]) -> str:
    return Path(path).suffix.lower()


def _write_exr(image: Image, data: CubeData, path: Path, force: bool) -> None:
    channels = {letter: image[..., i] for i, letter in enumerate("RGB")}
    exr.write_parts([exr.make_part("sheet", exr.attributes(data), channels)], path, force=force)


def _write_png(image: Image, data: CubeData, path: Path, force: bool) -> None:
    from matplotlib.image import imsave

    codes = np.rint(255 * encode(image)).astype(np.uint8)
    # Without this entry matplotlib writes its own name and version.
    with atomic_write(path, force=force) as temporary:
        imsave(temporary, codes, format="png", metadata={"Software": "uplift"})


WRITERS = {".exr": _write_exr, ".png": _write_png}


def _draw_text(image: Image, labels: tuple[Label, ...]) -> Image:
    """Draw the labels on the image (height, width, 3) in the font that comes with matplotlib."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = image.shape[:2]
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="none")
    for label in labels:
        text = figure.text(label.x / width, 1 - label.y / height, figure_text(label.text), **STYLE)
        text.set_fontsize(label.size * 72 / DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    cover = np.asarray(canvas.buffer_rgba())[..., 3:] / np.float32(255)
    return image + cover * (np.float32(TEXT_GREY) - image)
