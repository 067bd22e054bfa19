"""Look-up tables of a cube's colours under another light, for colour grading.

RGB under the illuminant of the cube in, RGB under another light out, in the
RGB space of the cube. Nodes are even steps of the sRGB curve, which are nearly even to
the eye. A ``.cube`` table has encoded components in and out. A ``.clf`` file has linear
ones: curve, table, and the inverse of the curve.

Cube LUT Specification 1.0, Adobe 2013; Common LUT Format 3.0, AMPAS S-2014-006.
"""

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, StrPath, Values
from uplift.common.files import write_text
from uplift.extras.colour.srgb import decode
from uplift.extras.export.grid_table import (
    TableError,
    check_res,
    find_errors,
    grid_nodes,
)
from uplift.extras.export.material_error import material_error
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube

SIZE = 33
MAX_SIZE = 129
CLF = "Academy/ASC Common LUT Format"
CURVE = {"gamma": [2.4, 2.4, 2.4, 1.0], "offset": [0.055, 0.055, 0.055, 0.0]}
"""The sRGB curve, as OpenColorIO states it."""
SLOPE = 12.92
"""Slope of its line, which goes on below 0."""


def export(
    cube: Cube, path: Path, style: str, *, light: Illuminant, **settings: Any
) -> str:
    """Write colours under a light."""
    error = write_lut(cube, light, path, **settings)
    facts = [f"colours under {light}, {error}"]
    on_materials = material_error(cube, light)
    if on_materials is not None:
        facts.append(str(on_materials))
    if path.suffix.lower() != ".clf":
        facts.append(f"a component x below 0 is coded as {SLOPE:g} x")
    return "; ".join(facts)


def write_lut(
    cube: Cube,
    light: Illuminant,
    path: StrPath,
    *,
    res: int = SIZE,
    adapt: bool = True,
    force: bool = False,
) -> TableError:
    """Write the colours of reflectances under a light as a table of ``res``³ nodes, 2
    to 129, ``.clf`` or ``.cube``.

    With ``adapt`` the white of the light is shown as white (Bradford); otherwise
    colours have its tint. Returns the errors with OpenColorIO's interpolation. The cube
    of a camera is a `ColourError`.
    """
    check_res(res, SIZE, MAX_SIZE)
    sensor = cube.data.sensor
    sensor.require_xyz()
    (lit,) = display_sensors(
        [light], sensor.observer, *sensor.range, space=sensor.space
    )
    # RGB = M XYZ: M adapted to the white of the light, or that of the cube's own
    # illuminant.
    screen = lit if adapt else replace(lit, xyz_to_rgb=sensor.xyz_to_rgb)
    nodes = grid_nodes(np.linspace(0, 1, res), 3)
    table = _encode(_relit(cube, nodes, screen)).astype(np.float32)
    transform = _linear_to_linear(table, res)
    title = f"uplift: {sensor.space} under {sensor.illuminant} to {screen.illuminant}"
    is_clf = os.fspath(path).lower().endswith(".clf")
    text = _clf(transform, title) if is_clf else cube_text(table, title, res)
    write_text(text, path, force=force)
    return _errors(cube, transform, screen)


def _relit(cube: Cube, codes: Array, screen: Sensor) -> Array:
    """Return linear RGB (n, 3) under the light of colours in encoded RGB (n, 3)."""
    return blockwise(
        lambda rows: (
            cube.reflectance(decode(rows), screen.wavelengths) @ screen.matrix.T
        ),
        codes,
        3,
    )


def _encode(linear: Array) -> Array:
    """Encode by the sRGB curve: below 0 its line goes on, above 1 its power."""
    return np.where(
        linear <= 0.0031308,
        SLOPE * linear,
        1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055,
    )


def _linear_to_linear(table: Values, size: int) -> Any:
    """Return the table between the sRGB curve and its inverse, as a transform of
    OpenColorIO.
    """
    import PyOpenColorIO as ocio  # noqa: N813

    lut = ocio.Lut3DTransform(gridSize=size)
    lut.setData(table.ravel())
    lut.setInterpolation(ocio.INTERP_TETRAHEDRAL)
    decoding = ocio.ExponentWithLinearTransform(**CURVE)
    encoding = ocio.ExponentWithLinearTransform(
        **CURVE, direction=ocio.TRANSFORM_DIR_INVERSE
    )
    return ocio.GroupTransform([encoding, lut, decoding])


def _clf(transform: Any, title: str) -> str:
    import PyOpenColorIO as ocio  # noqa: N813

    transform.getFormatMetadata().addChildElement("Description", title)
    return str(transform.write(formatName=CLF, config=ocio.Config.CreateRaw()))


def cube_text(table: Values, title: str, size: int) -> str:
    """Return the text of a ``.cube`` file, in which red varies fastest."""
    rows = table.reshape(size, size, size, 3).transpose(2, 1, 0, 3).reshape(-1, 3)
    texts = [f"{red:.7g} {green:.7g} {blue:.7g}" for red, green, blue in rows.tolist()]
    lines = "\n".join(texts)
    return (
        f"# {title}\n# sRGB-encoded components in and out\nLUT_3D_SIZE "
        f"{size}\n{lines}\n"
    )


def _errors(cube: Cube, transform: Any, screen: Sensor) -> TableError:
    import PyOpenColorIO as ocio  # noqa: N813

    processor = ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor()

    def error(codes: Array) -> Array:
        pixels = decode(codes).astype(np.float32)
        processor.applyRGB(pixels)
        return delta_e_rgb(screen, pixels.astype(float), _relit(cube, codes, screen))

    return find_errors(error, cube.data.atlas.rgb)
