"""Images of every kind, and textures as OpenEXR's own reader sees them."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import OpenEXR
import pytest

from uplift.io import texture

PHOTO = Path(matplotlib.get_data_path()) / "sample_data" / "grace_hopper.jpg"
AT = (400.0, 430.0, 460.0, 500.0, 540.0, 580.0, 620.0, 660.0, 700.0)
"""nm"""


def channels(path, part=0):
    """(h, w) of every channel."""
    return {
        name: channel.pixels
        for name, channel in OpenEXR.File(str(path), separate_channels=True).parts[part].channels.items()
    }


def held(path, names, part=0):
    """(h, w, N) of named channels."""
    found = channels(path, part)
    return np.stack([found[name] for name in names], axis=-1)


def write_exr(path, planes, **header):
    """A part of planes (h, w)."""
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, planes).write(str(path))
    return path


def planes(rgb):
    return {letter: np.ascontiguousarray(rgb[..., place]) for place, letter in enumerate("RGB")}


def small_tiles():
    """Of 16 × 16 pixels."""
    found = OpenEXR.TileDescription()
    found.xSize = found.ySize = 16
    return found


@pytest.fixture(scope="session")
def spectral(small_cube):
    """Nine wavelengths of the ColorChecker cube, as many as coefficients: compiled once for both."""
    return texture.prepare(small_cube, texture.Spectrum(AT), depth="float", threads=1)


@pytest.fixture(scope="session")
def colours():
    """(20, 30, 3) linear RGB in [0, 1], float32; corners of the cube among them."""
    rgb = np.random.default_rng(0).random((20, 30, 3)).astype(np.float32)
    rgb[0, :8] = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
    return rgb
