"""The table of rgb2spec: sigmoid spectra, for Mitsuba and colour-science, pbrt and
LuisaRender.

The first axis of the table is the largest component l. The second axis is its value,
scale[k]. The last two are the other components as even fractions of it, l + 2 before l
+ 1 (modulo 3). A spectrum is S(c₀λ² + c₁λ + c₂) with λ in nm and S(t) = ½ + t / (2√(1 +
t²)). Programs hold the same numbers in three layouts:

- coeff, little-endian: "SPEC", u32 res, f32 scale[res], f32 data[3][res][res][res][3].
  The sensor follows, which Mitsuba 3.9 and later require and other programs ignore: u32
  count, f32 wavelength[count] as fractions of 360–830 nm, f32 rgb[3][count] of a
  reflectance there, f32 rgb_to_xyz[3][3], f32 white_xyz[3].
- pbrt, a source file in C++: ``NAMEToSpectrumTable_Res``, ``_Scale`` and ``_Data``.
- luisa, a source file in C++: ``sRGBToSpectrumTable_Data``, with a fourth number, 0,
  after the three.

Three coefficients per spectrum determine a colour. The table therefore reproduces the
cube's colours, but not the spectra of its atlas. Colours are those of the readers'
tables, 360–830 nm at 5 nm.

W. Jakob and J. Hanika, "A Low-Dimensional Function Space for Efficient Spectral
Upsampling", CGF 38(2), 2019, and its reference implementation ``rgb2spec``.
"""

import struct
from pathlib import Path
from string import Template

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import on_range
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Floats, Indices, StrPath, Values, blocks
from uplift.common.errors import OptionError
from uplift.common.files import atomic_write
from uplift.cube.data import CubeData
from uplift.extras.colour.srgb import decode
from uplift.extras.export.grid_table import (
    TableError,
    check_res,
    find_errors,
    grid_nodes,
)
from uplift.extras.export.source import read_source
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import around
from uplift.models.arithmetic import blocked_matmul
from uplift.models.least_squares import least_squares
from uplift.models.sigmoid import Sigmoid, evaluate_unscaled, unscaled

MAGIC = b"SPEC"
RES = 64
"""Resolution of Mitsuba's own table."""
MAX_RES = 256
DARK = 1e-3
"""Level of linear RGB up to which `DARK_COLOUR` holds."""
DARK_COLOUR = 1e-4
"""Up to `DARK`, the difference ε of a component of linear RGB that weighs as much
as the distance of a spectrum from grey; above, ε falls with the level. Very dark
colours of high purity would else have reflectances near 1 where the eye hardly
responds.
"""
FAINT = 1e-6
"""Reflectance of black, and 1 minus that of white, whose multipliers are infinite."""
PRECISION = 1e-6
MAX_STEPS = 200
BLOCK = 1 << 10
"""Points of a level that are fitted at a time."""
START = 360.0
"""First wavelength in nm of rgb2spec, and of the programs that read its tables."""
END = 830.0
"""Last wavelength in nm."""
STEP = 5.0
"""Step in nm."""
MODEL = Sigmoid(START, END)
SYMBOLS = {
    ("sRGB", "D65"): "sRGB",
    ("P3-D65", "D65"): "DCI_P3",
    ("Display P3", "D65"): "DCI_P3",
    ("ITU-R BT.2020", "D65"): "REC2020",
    ("ACES2065-1", "D60"): "ACES2065_1",
}
"""Names of the tables of pbrt by space and illuminant."""
PROGRAMS = {"pbrt": tuple(SYMBOLS), "luisa": (("sRGB", "D65"),)}
"""Spaces and illuminants of the tables of programs; rgb2spec takes all."""


def export(
    cube: Cube, path: Path, style: str, *, force: bool, res: int | None = None
) -> str:
    """Write sigmoids in the layout of the format."""
    given = {} if res is None else {"res": res}
    error = write_coeff(cube.data, path, layout=style, force=force, **given)
    return f"table of sigmoids, {error}"


def write_coeff(
    data: CubeData,
    path: StrPath,
    *,
    layout: str = "coeff",
    res: int = RES,
    force: bool = False,
) -> TableError:
    """Write a cube as a table of sigmoid spectra with ``res`` points along each axis, 2
    to 256.

    The layout is coeff, pbrt or luisa; pbrt and LuisaRender are compiled for 64 points.
    Readers interpret RGB in the cube's space under its illuminant; Mitsuba and
    LuisaRender assume sRGB under D65. Returns the errors of colours that rgb2spec
    interpolates, under the light of the cube. Raises `ColourError` for the cube of a
    camera, `OptionError` for a space or an illuminant without a table in the program.
    """
    data.sensor.require_xyz()
    check_res(res, RES, MAX_RES)
    sensor = on_range(data.sensor, START, END, STEP)
    light = (sensor.space, sensor.illuminant)
    if light not in PROGRAMS.get(layout, (light,)):
        known = [f"{space} under {name}" for space, name in PROGRAMS[layout]]
        raise OptionError(
            f"a {layout} table needs {' or '.join(known)}, got {light[0]} under "
            f"{light[1]}",
            hint="build a cube of this space and illuminant",
        )
    with atomic_write(path, force=force) as temporary:
        scale = _scale(res)
        levels = _fit(data, sensor, scale, _directions(res))
        table = levels.reshape(res, 3, res, res, 3).swapaxes(0, 1)
        if layout == "coeff":
            content = _binary(sensor, scale, table)
        else:
            content = _source(layout, SYMBOLS[light], scale, table).encode()
        temporary.write_bytes(content)
    return _errors(data, sensor, scale, table)


def _binary(sensor: Sensor, scale: Array, table: Floats) -> bytes:
    at = (sensor.wavelengths - START) / (END - START)
    forward = (at, sensor.matrix, sensor.rgb_to_xyz, sensor.xyz(np.ones(3)))
    content = MAGIC
    for length, arrays in ((len(scale), (scale, table)), (len(at), forward)):
        content += struct.pack("<I", length)
        for numbers in arrays:
            content += numbers.astype("<f4").tobytes()
    return content


def _source(layout: str, name: str, scale: Array, table: Floats) -> str:
    numbers = np.pad(table, [(0, 0)] * 4 + [(0, 1)]) if layout == "luisa" else table
    words = {
        "name": name,
        "res": str(len(scale)),
        "scale": _rows(scale),
        "data": _rows(numbers),
    }
    return Template(read_source(f"{layout}.cpp")).substitute(words)


def _rows(numbers: Values) -> str:
    lines = []
    for row in numbers.reshape(-1, numbers.shape[-1]).tolist():
        words = (f"{number:.9g}," for number in row)
        lines.append("".join(words))
    return "\n".join(lines)


def _scale(res: int) -> Array:
    """Return values (res,) of the largest component, dense near 0 and 1, where spectra
    change most.
    """
    x = np.linspace(0, 1, res)
    for _ in range(2):
        x = x * x * (3 - 2 * x)
    return x


def _directions(res: int) -> Array:
    """Return linear RGB (3·res·res, 3) of the table's points whose largest component is
    1.
    """
    second, first = grid_nodes(np.linspace(0, 1, res), 2).T
    shares = np.stack([np.ones_like(first), first, second], axis=-1)
    return np.concatenate([np.roll(shares, largest, axis=-1) for largest in range(3)])


def _fit(data: CubeData, sensor: Sensor, scale: Array, directions: Array) -> Floats:
    """Fit coefficients (res, n, 3) of the levels of directions (n, 3).

    Levels are fitted upwards and downwards from a medium one. Each starts from the
    multipliers of the previous level, so that neighbours are similar and can be
    interpolated.
    """
    middle = len(scale) // 5
    table = np.empty((len(scale), len(directions), 3), dtype=np.float32)
    for rows in blocks(len(directions), BLOCK):
        start = np.zeros((len(directions[rows]), 3))
        for levels in (range(middle, len(scale)), range(middle - 1, -1, -1)):
            multipliers = start
            for level in levels:
                target = _targets(data, scale[level] * directions[rows])
                multipliers = _nearest_to_grey(
                    sensor, multipliers, target, scale[level]
                )
                if level == middle:
                    start = multipliers
                table[level, rows] = unscaled(MODEL, multipliers)
    return table


def _nearest_to_grey(
    sensor: Sensor, start: Array, target: Array, level: float
) -> Array:
    """Minimise |r(p) − t|² / ε² + |p − g|² / s² over p (n, 3) from a start.

    g are the multipliers of the grey of this level, and s their size, at least 1.
    """
    grey = MODEL.from_reflectance(np.clip(level, FAINT, 1 - FAINT)) * MODEL.constant()
    size = np.maximum(np.abs(grey).max(), 1)
    unit = DARK_COLOUR * DARK / max(level, DARK)
    basis = MODEL.basis(sensor.wavelengths)
    weights = sensor.matrix.T / unit
    products = (weights[:, :, None] * basis[:, None]).reshape(len(basis), -1)

    def residuals(p: Array, rows: Indices) -> Array:
        colour = blocked_matmul(
            MODEL.to_reflectance(blocked_matmul(p, basis.T)), weights
        )
        return np.concatenate([colour - target[rows] / unit, (p - grey) / size], axis=1)

    def normal_equations(p: Array, residual: Array, _: Indices) -> tuple[Array, Array]:
        slopes = blocked_matmul(MODEL.derivative(blocked_matmul(p, basis.T)), products)
        jacobian = slopes.reshape(-1, 3, 3)
        transposed = jacobian.swapaxes(1, 2)
        towards = transposed @ residual[:, :3, None] + residual[:, 3:, None] / size
        return transposed @ jacobian + np.eye(3) / size**2, towards[..., 0]

    return least_squares(
        residuals, normal_equations, start, max_steps=MAX_STEPS, precision=PRECISION
    )


def _targets(data: CubeData, rgb: Array) -> Array:
    """Return linear RGB (n, 3) of the spectra that the cube answers."""
    return around(data, rgb).weighted_sum(data.points.rgb.astype(float), data.atlas.rgb)


def _errors(data: CubeData, sensor: Sensor, scale: Array, table: Floats) -> TableError:
    def error(codes: Array) -> Array:
        rgb = decode(codes)
        spectra = evaluate_unscaled(
            _interpolated(scale, table, rgb), sensor.wavelengths
        )
        return delta_e_rgb(sensor, sensor.rgb(spectra), _targets(data, rgb))

    return find_errors(error, data.atlas.rgb)


def _interpolated(scale: Array, table: Floats, rgb: Array) -> Array:
    """Return coefficients (n, 3) as rgb2spec interpolates them: linearly between the
    eight points around a colour.
    """
    from scipy.interpolate import interpn

    largest = rgb.argmax(axis=1)
    rows = np.arange(len(rgb))
    even = np.linspace(0, 1, len(scale))
    level = np.maximum(rgb[rows, largest], np.finfo(float).tiny)  # of black
    shares = [rgb[rows, (largest + step) % 3] / level for step in (2, 1)]
    places = np.stack([level, *shares], axis=-1)
    coefficients = np.zeros((len(rgb), 3))
    for axis in range(3):
        colours = largest == axis
        axes = (scale, even, even)
        coefficients[colours] = interpn(axes, table[axis], places[colours])
    return coefficients
