"""Accuracy, speed and memory of spectral textures, for docs/textures.md."""

import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenEXR

import uplift
from benchmarks import CUBES, MACBETH, Row, record
from benchmarks.performance import UPLIFT
from benchmarks.pictures import Picture, colour, pictures
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras import texture
from uplift.extras.texture.uplifter import PixelEncoding
from uplift.lab.timing import time_process
from uplift.lookup import Cube
from uplift.models import Moments, evaluate
from uplift.models.moments import multipliers_of_rounded

FORMS: tuple[tuple[str, PixelEncoding, str], ...] = (
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
    """Yield ΔE00 between each image and its textures, read by OpenEXR and, where
    spectral, by colour-science.
    """
    uplifters = [
        (name, form, texture.prepare(cube, form, depth=depth))
        for name, form, depth in FORMS
    ]
    for picture in images:
        linear = np.clip(picture.linear(), 0, 1)
        errors = {}
        colour_science = {}
        for name, form, uplifter in uplifters:
            texture.convert(uplifter, picture.path, target, force=True)
            found = delta_e_rgb(
                cube.data.sensor, linear, _rgb(cube, form, uplifter.channels, target)
            )
            errors[name] = [float(found.mean()), float(found.max())]
            if isinstance(form, texture.Spectrum):
                found = delta_e_rgb(
                    cube.data.sensor, linear, _rgb_by_colour_science(target)
                )
                colour_science[name] = float(found.mean())
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
        if isinstance(model, Moments) and isinstance(form, texture.Moments):
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
    io = colour.io.fichet2021
    with warnings.catch_warnings(action="ignore"):
        at, values = io.read_spectral_image_Fichet2021(path)["T"]
        blocks = [
            values[first : first + ROWS].astype(float)
            for first in range(0, len(values), ROWS)
        ]
        return np.concatenate(
            [io.components_to_sRGB_Fichet2021({"T": (at, rows)})[0] for rows in blocks]
        )


def fewer_wavelengths(
    cube: Cube, images: list[Picture], target: Path, first: int, last: int, step: int
) -> Row:
    """Return ΔE00 of half-float spectra at first:last:step nm, converted back by
    colour-science.
    """
    wavelengths = tuple(
        float(wavelength) for wavelength in range(first, last + 1, step)
    )
    uplifter = texture.prepare(cube, texture.Spectrum(wavelengths))
    means = []
    worst = 0.0
    for picture in images:
        texture.convert(uplifter, picture.path, target, force=True)
        linear = np.clip(picture.linear(), 0, 1)
        errors = delta_e_rgb(cube.data.sensor, linear, _rgb_by_colour_science(target))
        means.append(float(errors.mean()))
        worst = max(worst, float(errors.max()))
    return {
        "wavelengths": f"{first}:{last}:{step}"
        + (", the default" if (first, last, step) == GRIDS[0] else ""),
        "channels": len(wavelengths),
        "bytes": 2 * (len(wavelengths) + 3),
        "lowest_mean": min(means),
        "highest_mean": max(means),
        "max": worst,
    }


FEW = ("--wavelengths", "400:700:10")
JOBS: tuple[tuple[int, tuple[str, ...], int], ...] = (
    (2048, (), 3),
    (2048, ("--representation", "moments"), 3),
    (2048, ("--representation", "multipliers"), 1),
    (4096, FEW, 1),
    (8192, FEW, 1),
    (8192, ("--representation", "moments"), 1),
)
"""Size, options, runs."""


def _write(path: Path, size: int) -> None:
    """Write a photograph tiled to size² pixels as 8-bit PNG, with noise so that the
    tiles do not compress.
    """
    import OpenImageIO
    from PIL import Image

    photo = np.asarray(
        Image.open(next(iter(pictures())).path).convert("RGB"), dtype=int
    )
    rng = np.random.default_rng(0)
    height = photo.shape[0]
    tiled = np.tile(photo, (1, size // photo.shape[1], 1))
    image = OpenImageIO.ImageOutput.create("png")
    if image is None or not image.open(
        str(path), OpenImageIO.ImageSpec(size, size, 3, "uint8")
    ):
        raise RuntimeError(OpenImageIO.geterror())
    for first in range(0, size, height):
        noisy = np.clip(tiled + rng.integers(-3, 4, tiled.shape), 0, 255).astype(
            np.uint8
        )
        image.write_scanlines(first, first + height, 0, noisy)
    image.close()


def time_textures(cube: Path, size: int, options: tuple[str, ...], runs: int) -> Row:
    """Time a process that uplifts size² pixels."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "in.png"
        target = Path(folder) / "out.exr"
        _write(source, size)
        command = [
            UPLIFT,
            "texture",
            str(source),
            "-o",
            str(target),
            "--cube",
            str(cube),
            "--force",
            *options,
        ]
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
    speed = [time_textures(CUBES / "moments-16-macbeth.uplift", *job) for job in JOBS]
    cube = uplift.build(MACBETH, dim=32)
    images = list(pictures())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"
        found = list(round_trips(cube, images, target))
        fewer = [fewer_wavelengths(cube, images, target, *grid) for grid in GRIDS]
    record("textures", round_trips=found, wavelengths=fewer, speed=speed)
