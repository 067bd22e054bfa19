"""Textures of real images, read by others and seen as sRGB again."""

from __future__ import annotations

import tempfile
import warnings
from pathlib import Path

import numpy as np
import OpenEXR

from benchmarks.page import table
from benchmarks.textures.pictures import Picture, colour, pictures
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.io import texture
from uplift.lookup import Cube
from uplift.models import evaluate, reflectance

FORMS: tuple[tuple[str, texture.PixelEncoding, str], ...] = (
    ("spectrum, half", texture.Spectrum(), "half"),
    ("spectrum, float", texture.Spectrum(), "float"),
    ("moments, half", texture.Moments(), "half"),
    ("moments, float", texture.Moments(), "float"),
    ("multipliers, float", texture.Multipliers(), "float"),
)
ROWS = 64
"""Rows that colour-science is given at a time: it writes its tables into attributes at each call."""
GRIDS = ((380, 780, 5), (400, 700, 5), (380, 780, 10), (400, 700, 10), (380, 780, 20), (400, 700, 20))
"""First, last, step in nm."""


def sections(cube: Cube) -> list[str]:
    found = list(pictures())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"
        return [_forms(cube, found, target), _grids(cube, found, target)]


def _forms(cube: Cube, found: list[Picture], target: Path) -> str:
    ready = [texture.prepare(cube, form, depth=depth) for _, form, depth in FORMS]
    rows = []
    for picture in found:
        linear = np.clip(picture.linear(), 0, 1)
        cells = [f"{picture.path.name} ({picture.package})", f"{linear.size // 3:,}"]
        for (_, form, _), uplifter in zip(FORMS, ready, strict=True):
            texture.convert(uplifter, picture.path, target, force=True)
            apart = delta_e_rgb(cube.data.sensor, linear, _rgb(cube, form, uplifter.channels, target))
            cells.append(f"{apart.mean():.4f} / {apart.max():.3f}")
            if isinstance(form, texture.Spectrum):
                theirs = delta_e_rgb(cube.data.sensor, linear, _theirs(target))
                cells.append(f"{theirs.mean():.4f}")
        rows.append(cells)
    head = ["image", "pixels"]
    for name, form, _ in FORMS:
        head += [name, "by colour-science"] if isinstance(form, texture.Spectrum) else [name]
    return table(
        "Images that come back",
        "ΔE00 between an image, read by Pillow or OpenEXR, and its texture, read by OpenEXR, evaluated as the header "
        "tells, and integrated on the cube's own grid: mean / largest. *By colour-science*: the mean where "
        "`read_spectral_image_Fichet2021` and `components_to_sRGB_Fichet2021` do it all; they take sRGB's white for "
        "(0.3127, 0.3290), from which D65 at 5 nm differs, by 0.026 on white: that is nearly all of it.",
        head,
        rows,
    )


def _rgb(cube: Cube, form: texture.PixelEncoding, names: tuple[str, ...], path: Path) -> Array:
    sensor, model = cube.data.sensor, cube.data.model
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    shape = channels["R"].pixels.shape
    values = np.stack([channels[name].pixels.ravel() for name in names], axis=-1)
    blocks = []
    for block in np.array_split(values, max(len(values) // 50_000, 1)):
        numbers = block.astype(float)
        if isinstance(form, texture.Moments):
            numbers = reflectance(model, numbers, sensor.wavelengths)
        elif isinstance(form, texture.Multipliers):
            numbers = evaluate(model, numbers, sensor.wavelengths)
        blocks.append(sensor.rgb(numbers))
    return np.concatenate(blocks).reshape(*shape, 3)


def _theirs(path: Path) -> Array:
    """Linear sRGB by colour-science alone."""
    io = colour.io.fichet2021
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        at, values = io.read_spectral_image_Fichet2021(path)["T"]
        blocks = [values[first : first + ROWS].astype(float) for first in range(0, len(values), ROWS)]
        return np.concatenate([io.components_to_sRGB_Fichet2021({"T": (at, rows)})[0] for rows in blocks])


def _grids(cube: Cube, found: list[Picture], target: Path) -> str:
    rows = []
    for first, last, step in GRIDS:
        at = tuple(float(wavelength) for wavelength in range(first, last + 1, step))
        uplifter = texture.prepare(cube, texture.Spectrum(at))
        means, worst = [], 0.0
        for picture in found:
            texture.convert(uplifter, picture.path, target, force=True)
            apart = delta_e_rgb(cube.data.sensor, np.clip(picture.linear(), 0, 1), _theirs(target))
            means.append(apart.mean())
            worst = max(worst, apart.max())
        name = f"{first}:{last}:{step}" + (", the default" if (first, last, step) == GRIDS[0] else "")
        cells = [f"{min(means):.3f}–{max(means):.3f}", f"{worst:.2f}"]
        rows.append([name, str(len(at)), str(2 * (len(at) + 3)), *cells])
    return table(
        "Fewer wavelengths",
        "The same images as half-float spectra, back to sRGB by colour-science: means of the images and the largest "
        "ΔE00 of all. Bytes are those of a pixel before compression, R, G and B among them.",
        ["wavelengths", "channels", "bytes", "mean", "largest"],
        rows,
    )
