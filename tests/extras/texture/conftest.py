"""Fixtures: image files of all kinds, and textures read by the OpenEXR package."""

from pathlib import Path

import matplotlib
import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from uplift.extras import texture
from uplift.models.model import evaluate

PHOTO = Path(matplotlib.get_data_path()) / "sample_data" / "grace_hopper.jpg"
WAVELENGTHS = (400.0, 430.0, 460.0, 500.0, 540.0, 580.0, 620.0, 660.0, 700.0)
"""nm"""


def channels(path, part=0):
    """Read every channel (h, w) of a part."""
    parts = OpenEXR.File(str(path), separate_channels=True).parts
    return {name: channel.pixels for name, channel in parts[part].channels.items()}


def read_channels(path, names, part=0):
    """Read named channels (h, w, N) of a part."""
    planes = channels(path, part)
    return np.stack([planes[name] for name in names], axis=-1)


def write_exr(path, planes, **header):
    """Write planes (h, w) as a single part."""
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, planes).write(str(path))
    return path


def write_image(path, values, **attributes):
    """Write values (h, w, n) in the format of the suffix. An attribute is a value, or a
    type and a value.
    """
    height, width, count = values.shape
    spec = OpenImageIO.ImageSpec(width, height, count, str(values.dtype))
    for name, value in attributes.items():
        spec.attribute(name, *(value if isinstance(value, tuple) else (value,)))
    image = OpenImageIO.ImageOutput.create(str(path))
    assert image.open(str(path), spec)
    assert image.write_image(values)
    image.close()
    return path


def planes(rgb):
    return {
        letter: np.ascontiguousarray(rgb[..., place])
        for place, letter in enumerate("RGB")
    }


def small_tiles():
    """Describe tiles of 16 × 16 pixels."""
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 16
    return tiles


@pytest.fixture(scope="session")
def spectral(small_cube):
    """Uplifter for nine wavelengths, as many as coefficients, so that both share one
    compilation.
    """
    return texture.prepare(
        small_cube, texture.Spectrum(WAVELENGTHS), depth="float", threads=1
    )


@pytest.fixture(scope="session")
def colours():
    """Linear RGB (20, 30, 3) in [0, 1], float32, with the corners of the RGB cube."""
    rgb = np.random.default_rng(0).random((20, 30, 3)).astype(np.float32)
    rgb[0, :8] = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
    return rgb


@pytest.fixture
def to_texture(spectral, tmp_path):
    """Function that converts an image, a file or planes of one, and returns the
    outcome.
    """

    def to_texture(source, converter=spectral, **header):
        if isinstance(source, dict):
            source = write_exr(tmp_path / "in.exr", source, **header)
        return texture.convert(converter, source, tmp_path / "out.exr", force=True)

    return to_texture


def rgb_of(conversion):
    """Read RGB (h, w, 3) of a texture."""
    return read_channels(conversion.target, "RGB")


def spectra_by(numbers, encoding, cube):
    """Reflectance (..., N) at the wavelengths of the cube by the numbers of pixels."""
    model = cube.data.model
    if isinstance(encoding, texture.Spectrum):
        return numbers
    if isinstance(encoding, texture.Moments):
        numbers = model.from_storage(numbers.astype(float))
    spectra = evaluate(model, numbers.reshape(-1, model.count), cube.wavelengths)
    return spectra.reshape(*numbers.shape[:-1], -1)
