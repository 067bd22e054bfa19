"""Accuracy, speed and memory of spectral textures, for docs/textures.md."""

import tempfile
import warnings
from collections.abc import Iterator
from functools import partial
from itertools import starmap
from pathlib import Path

import numpy as np
import OpenEXR

import uplift
from benchmarks import CUBES, MACBETH, Row, record
from benchmarks.performance import UPLIFT
from benchmarks.pictures import Picture, pictures
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras import texture
from uplift.extras.texture.uplifter import PixelEncoding
from uplift.lab.timing import time_process
from uplift.lookup import Cube
from uplift.models import evaluate
from uplift.models.moments import multipliers_of_rounded

FORMS = (
    ("spectrum_half", texture.Spectrum(), "half"),
    ("spectrum_float", texture.Spectrum(), "float"),
    ("moments_half", texture.Moments(), "half"),
    ("moments_float", texture.Moments(), "float"),
    ("multipliers_float", texture.Multipliers(), "float"),
)
ROWS = 64
"""Rows per call of colour-science, which limits its memory."""
GRIDS = (
    (380, 780, 5),
    (400, 700, 5),
    (380, 780, 10),
    (400, 700, 10),
    (380, 780, 20),
    (400, 700, 20),
)
"""First, last, step in nm."""


def round_trips(cube: Cube, images: list[Picture], target: Path) -> Iterator[Row]:
    """Yield ΔE00 between images and their textures, read by OpenEXR and by
    colour-science.
    """
    uplifters = [
        (name, form, texture.prepare(cube, form, depth=depth))
        for name, form, depth in FORMS
    ]
    for picture in images:
        linear = np.clip(picture.linear(), 0, 1)
        difference = partial(delta_e_rgb, cube.data.sensor, linear)
        errors = {}
        colour_science = {}
        for name, form, uplifter in uplifters:
            texture.convert(uplifter, picture.path, target, force=True)
            delta_e = difference(_rgb(cube, form, uplifter.channels, target))
            errors[name] = [delta_e.mean(), delta_e.max()]
            if isinstance(form, texture.Spectrum):
                delta_e = difference(_rgb_by_colour_science(target))
                colour_science[name] = delta_e.mean()
        yield {
            "image": f"{picture.path.name} ({picture.package})",
            "pixels": linear.size // 3,
            "errors": errors,
            "colour_science": colour_science,
        }


def _rgb(cube: Cube, form: PixelEncoding, names: tuple[str, ...], path: Path) -> Array:
    """Return the linear RGB (h, w, 3) of a texture, read as Mitsuba reads it."""
    sensor = cube.data.sensor
    model = cube.data.model
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    shape = channels["R"].pixels.shape
    values = np.stack([channels[name].pixels.ravel() for name in names], axis=-1)
    blocks = []
    for block in np.array_split(values, max(len(values) // 50_000, 1)):
        numbers = block.astype(float)
        if isinstance(form, texture.Moments):
            numbers, valid = multipliers_of_rounded(model, numbers)
            if not valid.all():
                raise ValueError(
                    f"{path}: {(~valid).sum()} pixels hold no moments of a reflectance"
                )
        if not isinstance(form, texture.Spectrum):
            numbers = evaluate(model, numbers, sensor.wavelengths)
        blocks.append(sensor.rgb(numbers))
    return np.concatenate(blocks).reshape(*shape, 3)


def _rgb_by_colour_science(path: Path) -> Array:
    """Return linear sRGB, read and converted by colour-science alone."""
    from colour.io import fichet2021 as io  # without the warnings of its import

    with warnings.catch_warnings(action="ignore"):
        at, values = io.read_spectral_image_Fichet2021(path)["T"]
        blocks = []
        for first in range(0, len(values), ROWS):
            rows = values[first : first + ROWS].astype(float)
            blocks.append(io.components_to_sRGB_Fichet2021({"T": (at, rows)})[0])
        return np.concatenate(blocks)


def fewer_wavelengths(
    cube: Cube, images: list[Picture], target: Path, first: int, last: int, step: int
) -> Row:
    """Return ΔE00 of half-float spectra at first:last:step nm, by colour-science."""
    wavelengths = tuple(map(float, range(first, last + 1, step)))
    uplifter = texture.prepare(cube, texture.Spectrum(wavelengths))
    means = []
    largest = []
    for picture in images:
        texture.convert(uplifter, picture.path, target, force=True)
        linear = np.clip(picture.linear(), 0, 1)
        errors = delta_e_rgb(cube.data.sensor, linear, _rgb_by_colour_science(target))
        means.append(errors.mean())
        largest.append(errors.max())
    note = ", the default" if (first, last, step) == GRIDS[0] else ""
    return {
        "wavelengths": f"{first}:{last}:{step}{note}",
        "channels": len(wavelengths),
        "bytes": 2 * (len(wavelengths) + 3),
        "lowest_mean": min(means),
        "highest_mean": max(means),
        "max": max(largest),
    }


FEW = ("--wavelengths", "400:700:10")
JOBS = (
    (2048, (), 3),
    (2048, ("--representation", "moments"), 3),
    (2048, ("--representation", "multipliers"), 1),
    (4096, FEW, 1),
    (8192, FEW, 1),
    (8192, ("--representation", "moments"), 1),
)
"""Size, options, runs."""


def _write(path: Path, size: int) -> None:
    """Write a photograph tiled to size² pixels as PNG, with noise against
    compression.
    """
    import OpenImageIO
    from PIL import Image

    photo = np.asarray(Image.open(next(pictures()).path).convert("RGB"), dtype=int)
    rng = np.random.default_rng(0)
    height = photo.shape[0]
    tiled = np.tile(photo, (1, size // photo.shape[1], 1))
    image = OpenImageIO.ImageOutput.create("png")
    spec = OpenImageIO.ImageSpec(size, size, 3, "uint8")
    if image is None or not image.open(str(path), spec):
        raise RuntimeError(OpenImageIO.geterror())
    for first in range(0, size, height):
        noisy = np.clip(tiled + rng.integers(-3, 4, tiled.shape), 0, 255)
        image.write_scanlines(first, first + height, 0, noisy.astype(np.uint8))
    image.close()


def time_textures(size: int, options: tuple[str, ...], runs: int) -> Row:
    """Time a process that uplifts size² pixels."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "in.png"
        target = Path(folder) / "out.exr"
        _write(source, size)
        command = [UPLIFT, "texture", str(source), "-o", str(target), "--force"]
        command += ["--cube", str(CUBES / "moments-16-macbeth.uplift"), *options]
        wall, megabytes = time_process(command, runs)
        return {
            "options": " ".join(options) or "none: spectra at 81 wavelengths",
            "size": size,
            "seconds": wall,
            "written_mb": target.stat().st_size / 1e6,
            "peak_mb": megabytes,
        }


def main() -> None:
    """Measure and store."""
    # First: a process started from a large one counts the memory of its parent as its
    # own.
    speed = list(starmap(time_textures, JOBS))
    cube = uplift.build(MACBETH, dim=32)
    images = list(pictures())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"
        fewer = partial(fewer_wavelengths, cube, images, target)
        record(
            "textures",
            round_trips=round_trips(cube, images, target),
            wavelengths=starmap(fewer, GRIDS),
            speed=speed,
        )
