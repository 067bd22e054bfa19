"""Accuracy, speed and memory of spectral textures, for docs/textures.md."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, MACBETH, UPLIFT, Row, summary
from benchmarks.pictures import pictures
from benchmarks.timing import time_command
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras import texture
from uplift.extras.mitsuba.texels import Samples, read_texels
from uplift.extras.texture.encodings import PixelEncoding
from uplift.lookup.blocks import blockwise
from uplift.models.model import evaluate
from uplift.samples import sample_path

GRIDS = ((380, 780, 5), (400, 700, 5), (380, 780, 10), (400, 700, 10), (400, 700, 20))
"""First and last wavelength and step in nm of half-float spectra."""
OTHERS: tuple[tuple[PixelEncoding, str], ...] = (
    (texture.Spectrum(), "float"),
    (texture.Moments(), "half"),
    (texture.Moments(), "float"),
    (texture.Multipliers(), "float"),
)


def forms() -> Iterator[tuple[str, PixelEncoding, str]]:
    """Yield names, representations and depths: spectra by wavelengths, then others."""
    for first, last, step in GRIDS:
        spectrum = texture.Spectrum(tuple(map(float, range(first, last + 1, step))))
        yield f"spectrum, half, {first}:{last}:{step}", spectrum, "half"
    for encoding, depth in OTHERS:
        yield f"{encoding.name}, {depth}", encoding, depth


def round_trips() -> Iterator[Row]:
    """Yield the ΔE00 between images and their textures, read as for Mitsuba."""
    cube = uplift.build(MACBETH, dim=32)
    images = list(pictures())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "texture.exr"
        for form, encoding, depth in forms():
            uplifter = texture.prepare(cube, encoding, depth=depth)
            for picture in images:
                texture.convert(uplifter, picture.path, target, force=True)
                linear = np.clip(picture.linear(), 0, 1)
                errors = delta_e_rgb(cube.data.sensor, linear, colours(target))
                yield {
                    "form": form,
                    "channels": len(uplifter.channels),
                    "image": f"{picture.path.name} ({picture.package})",
                    **summary(errors.ravel()),
                }


def colours(path: Path) -> Array:
    """Return the linear RGB (h, w, 3) of a texture."""
    texels = read_texels(path)
    assert texels is not None
    model = texels.model
    if isinstance(model, Samples):
        step = (model.end - model.start) / (model.count - 1)
        grid = (model.start, model.end, step)
        return blockwise(observer.sensor(wavelengths=grid).rgb, texels.numbers, 3)
    sensor = observer.sensor()

    def rgb(multipliers: Array) -> Array:
        return sensor.rgb(evaluate(model, multipliers, sensor.wavelengths))

    return blockwise(rgb, texels.numbers, 3)


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
    """Write a sample of size² pixels, with noise in the last bits against
    compression.
    """
    from PIL import Image

    image = Image.open(sample_path("still-life.png")).convert("RGB")
    pixels = np.asarray(image.resize((size, size)))
    noise = np.random.default_rng(0).integers(0, 4, pixels.shape, dtype=np.uint8)
    Image.fromarray(pixels ^ noise).save(path)


QUESTIONS = {"speed": speed, "round_trips": round_trips}
