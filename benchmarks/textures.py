"""Accuracy, speed and memory of spectral textures, for docs/textures.md."""

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenEXR

import uplift
from benchmarks import CUBES, MACBETH, UPLIFT, Row, summary
from benchmarks.pictures import pictures
from uplift.colorimetry import delta_e_rgb, observer
from uplift.common.arrays import Array
from uplift.extras import texture
from uplift.extras.texture.uplifter import PixelEncoding
from uplift.lab.timing import time_command
from uplift.lookup import Cube
from uplift.models import evaluate
from uplift.models.moments import multipliers_of_rounded

GRIDS = ((380, 780, 5), (400, 700, 5), (380, 780, 10), (400, 700, 10), (400, 700, 20))
"""First and last wavelength and step in nm of half-float spectra."""
OTHERS: tuple[tuple[PixelEncoding, str], ...] = (
    (texture.Spectrum(), "float"),
    (texture.Moments(), "half"),
    (texture.Moments(), "float"),
    (texture.Multipliers(), "float"),
)
BLOCK = 50_000
"""Pixels that are evaluated at once."""


@dataclass(frozen=True)
class Form:
    """A representation, its depth, and the wavelengths in nm of its spectra."""

    name: str
    encoding: PixelEncoding
    depth: str
    grid: tuple[int, int, int] = GRIDS[0]


def forms() -> Iterator[Form]:
    """Yield spectra by wavelengths, then the other forms."""
    for grid in GRIDS:
        first, last, step = grid
        spectrum = texture.Spectrum(tuple(map(float, range(first, last + 1, step))))
        yield Form(f"spectrum, half, {first}:{last}:{step}", spectrum, "half", grid)
    for encoding, depth in OTHERS:
        yield Form(f"{encoding.name}, {depth}", encoding, depth)


def round_trips() -> Iterator[Row]:
    """Yield the ΔE00 between images and their textures, read as Mitsuba reads them."""
    cube = uplift.build(MACBETH, dim=32)
    images = list(pictures())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"
        for form in forms():
            uplifter = texture.prepare(cube, form.encoding, depth=form.depth)
            for picture in images:
                texture.convert(uplifter, picture.path, target, force=True)
                linear = np.clip(picture.linear(), 0, 1)
                found = colours(cube, form, uplifter.channels, target)
                yield {
                    "form": form.name,
                    "channels": len(uplifter.channels),
                    "image": f"{picture.path.name} ({picture.package})",
                    **summary(delta_e_rgb(cube.data.sensor, linear, found).ravel()),
                }


def colours(cube: Cube, form: Form, names: Sequence[str], path: Path) -> Array:
    """Return the linear RGB (h, w, 3) of a texture."""
    sensor = observer.sensor(wavelengths=form.grid)
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    pixels = np.stack([channels[name].pixels for name in names], axis=-1)
    values = pixels.reshape(-1, len(names))
    blocks = [
        sensor.rgb(reflectances(cube, form.encoding, values[first : first + BLOCK]))
        for first in range(0, len(values), BLOCK)
    ]
    return np.concatenate(blocks).reshape(*pixels.shape[:2], 3)


def reflectances(cube: Cube, form: PixelEncoding, values: Array) -> Array:
    """Return the reflectances (n, N) of pixels (n, channels). Raises `ValueError`."""
    values = values.astype(float)
    if isinstance(form, texture.Spectrum):
        return values
    if isinstance(form, texture.Moments):
        values, valid = multipliers_of_rounded(cube.data.model, values)
        if not valid.all():
            raise ValueError(f"{(~valid).sum()} pixels hold no moments of reflectances")
    return evaluate(cube.data.model, values, cube.wavelengths)


JOBS = (
    (2048, (), 3),
    (2048, ("--representation", "moments"), 3),
    (2048, ("--representation", "multipliers"), 1),
    (4096, ("--wavelengths", "400:700:10"), 1),
    (8192, ("--representation", "moments"), 1),
)
"""Size, options, runs."""


def speed() -> Iterator[Row]:
    """Yield the time and memory of processes that uplift images of size² pixels."""
    for size, options, runs in JOBS:
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "in.png"
            target = Path(folder) / "out.exr"
            write_image(source, size)
            command = [UPLIFT, "texture", str(source), "-o", str(target), "--force"]
            command += ["--cube", str(CUBES / "moments-16-macbeth.uplift"), *options]
            timing = time_command(command, runs)
            yield {
                "options": " ".join(options) or "none: spectra at 81 wavelengths",
                "size": size,
                "seconds": timing.wall,
                "written_mb": target.stat().st_size / 1e6,
                "peak_mb": timing.megabytes,
            }


def write_image(path: Path, size: int) -> None:
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


QUESTIONS = {"speed": speed, "round_trips": round_trips}
