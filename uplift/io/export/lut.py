"""A cube's relighting as a look-up table of colour grading: RGB under its illuminant in, RGB under another light out.

Nodes are even steps of the sRGB curve, which are nearly even to the eye. A ``.cube`` table has encoded components in
and out. A ``.clf`` file has linear ones: curve, table, and the inverse of the curve. Both are written for the RGB space
of the cube.

References
----------
Cube LUT Specification 1.0, Adobe 2013; Common LUT Format 3.0, AMPAS S-2014-006.
"""

import os
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import decode
from uplift.common.arrays import Array, StrPath, Values
from uplift.common.errors import OptionError
from uplift.common.files import write_text
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise

SIZE, MIN_SIZE, MAX_SIZE = 33, 2, 129
SAMPLES, SEED = 4096, 7
"""Random colours, even in codes, on which the table is compared with the cube."""
CLF = "Academy/ASC Common LUT Format"
CURVE = {"gamma": [2.4, 2.4, 2.4, 1.0], "offset": [0.055, 0.055, 0.055, 0.0]}
"""The sRGB curve, as OpenColorIO states it."""


@dataclass(frozen=True)
class LutError:
    """ΔE00 between colours from the table and from the cube."""

    mean: float
    largest: float


def write_lut(
    cube: Cube, light: str, path: StrPath, *, res: int = SIZE, adapt: bool = True, force: bool = False
) -> LutError:
    """Write the colours of reflectances under a light as a table of ``res``³ nodes, 2 to 129, ``.clf`` or ``.cube``.

    With ``adapt`` the white of the light is shown as white (Bradford); otherwise colours have its tint. Returns the
    error of 4096 random colours with OpenColorIO's interpolation. The cube of a camera is a `ColourError`.
    """
    if not MIN_SIZE <= res <= MAX_SIZE:
        raise OptionError(f"res must be from {MIN_SIZE} to {MAX_SIZE}, got {res}", hint=f"{SIZE} is usual")
    cube.data.sensor.require_xyz()
    screen = _screen(cube, light, adapt)
    codes = np.linspace(0, 1, res)
    nodes = np.stack(np.meshgrid(codes, codes, codes, indexing="ij"), axis=-1).reshape(-1, 3)  # blue varies fastest
    table = _encode(_relit(cube, nodes, screen)).astype(np.float32)
    transform = _linear_to_linear(table, res)
    title = f"uplift: {cube.data.sensor.space} under {cube.data.sensor.illuminant} to {screen.illuminant}"
    is_clf = os.fspath(path).lower().endswith(".clf")
    write_text(_clf(transform, title) if is_clf else cube_text(table, title, res), path, force=force)
    return _error(cube, transform, screen)


def _screen(cube: Cube, light: str, adapt: bool) -> Sensor:
    """Return the sensor of the cube's RGB space for reflectances under the light."""
    own = cube.data.sensor
    (lit,) = display_sensors([light], own.observer, *own.range, space=own.space)
    # RGB = M XYZ: M adapted to the white of the light, or that of the cube's own illuminant.
    return lit if adapt else replace(lit, xyz_to_rgb=own.xyz_to_rgb)


def _relit(cube: Cube, codes: Array, screen: Sensor) -> Array:
    """Return linear RGB (n, 3) under the light of colours in encoded RGB (n, 3)."""
    return blockwise(lambda rows: cube.reflectance(decode(rows), screen.wavelengths) @ screen.matrix.T, codes, 3)


def _encode(linear: Array) -> Array:
    """Encode by the sRGB curve: below 0 its line goes on, above 1 its power."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


def _linear_to_linear(table: Values, size: int) -> Any:
    """Return the table between the sRGB curve and its inverse, as a transform of OpenColorIO."""
    import PyOpenColorIO as ocio  # noqa: N813

    lut = ocio.Lut3DTransform(gridSize=size)
    lut.setData(table.ravel())
    lut.setInterpolation(ocio.INTERP_TETRAHEDRAL)
    decoding = ocio.ExponentWithLinearTransform(**CURVE)
    encoding = ocio.ExponentWithLinearTransform(**CURVE, direction=ocio.TRANSFORM_DIR_INVERSE)
    return ocio.GroupTransform([encoding, lut, decoding])


def _clf(transform: Any, title: str) -> str:
    import PyOpenColorIO as ocio  # noqa: N813

    transform.getFormatMetadata().addChildElement("Description", title)
    return str(transform.write(formatName=CLF, config=ocio.Config.CreateRaw()))


def cube_text(table: Values, title: str, size: int) -> str:
    """Return the text of a ``.cube`` file, in which red varies fastest."""
    rows = table.reshape(size, size, size, 3).transpose(2, 1, 0, 3).reshape(-1, 3)
    lines = "\n".join(" ".join(f"{value:.7g}" for value in row) for row in rows.tolist())
    return f"# {title}\n# sRGB-encoded components in and out\nLUT_3D_SIZE {size}\n{lines}\n"


def _error(cube: Cube, transform: Any, screen: Sensor) -> LutError:
    """Compare the table, as OpenColorIO applies it, with the cube."""
    import PyOpenColorIO as ocio  # noqa: N813

    codes = np.random.default_rng(SEED).random((SAMPLES, 3))
    pixels = decode(codes).astype(np.float32)
    ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor().applyRGB(pixels)
    errors = delta_e_rgb(screen, pixels.astype(float), _relit(cube, codes, screen))
    return LutError(float(errors.mean()), float(errors.max()))
