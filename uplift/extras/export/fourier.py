"""Fourier sRGB for textures of 8 bits: a table from sRGB, and a shader of the spectra.

Its colours are three numbers in [0, 1] that are linear in the spectrum. The moments c
of a cube of three coefficients are a linear function of the linear components f of this
colour space. f are near linear RGB, grey is f = (g, g, g), and the codes of f
have the sRGB curve. Textures with such codes are filtered, and compressed in blocks, as
those of sRGB are. A shader evaluates their spectra: its file is next to the table from
sRGB to Fourier sRGB, a ``.png`` image of all 256³ codes or a ``.cube`` table of fewer.
The image is a Hald image of level 16: pixels row by row, with red varying fastest, then
green, then blue.

Peters, Merzbach, Hanika & Dachsbacher 2019, "Spectral rendering with the bounded MESE
and sRGB data", MAM 2019.
"""

from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array, Floats, StrPath, Values
from uplift.common.errors import OptionError, TextureError
from uplift.common.files import atomic_write, write_text
from uplift.cube import CubeData
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export.lut import MAX_SIZE, MIN_SIZE, SIZE, cube_text
from uplift.extras.export.outputs import output_files
from uplift.extras.export.program import identifier, literal, read_source
from uplift.extras.export.program_table import model_constants
from uplift.extras.export.table_error import TableError, find_errors
from uplift.extras.files.outputs import check_outputs
from uplift.lookup import Cube
from uplift.models import Moments, evaluate
from uplift.models.moments import WARPS, multipliers_of_rounded

COUNT = 3
LEVEL = 16


def export(cube: Cube, path: Path, style: str, **settings: Any) -> str:
    """Write the table and the shader of textures of 8 bits."""
    error = write_fourier(cube, path, **settings)
    _, shader = output_files(path, style)
    return f"shader in {shader}, with 8 bits {error}"


def write_fourier(
    cube: Cube, path: StrPath, *, res: int | None = None, force: bool = False
) -> TableError:
    """Write the table from sRGB to Fourier sRGB, and the shader of its spectra as a
    ``.glsl`` file.

    The cube has three moments, and sRGB or another space with its curve; `OptionError`
    otherwise. A ``.cube`` file has ``res`` nodes along each axis, 2 to 129, by default
    33; a ``.png`` has all codes. Returns the errors under the light of the cube, with
    codes of 8 bits before and after.
    """
    data = cube.data
    path = Path(path)
    if not isinstance(data.model, Moments) or data.model.count != COUNT:
        raise OptionError(
            "Fourier sRGB needs a cube of three moments",
            hint="build one with coefficients=3",
        )
    if np.abs(data.sensor.decoding - decode(np.arange(256) / 255)).max() > 1e-6:
        raise OptionError(
            f"Fourier sRGB needs the curve of sRGB, got {data.sensor.space}"
        )
    is_image = path.suffix.lower() == ".png"
    if res is not None and (is_image or not MIN_SIZE <= res <= MAX_SIZE):
        raise OptionError(
            f"res must be from {MIN_SIZE} to {MAX_SIZE}, and of a .cube table, got "
            f"{res}"
        )
    files = output_files(path, "fourier")
    check_outputs(files, force=force)
    size = LEVEL**2 if is_image else res or SIZE
    matrix = _to_moments(data)
    table = _table(cube, np.linspace(0, 1, size), matrix)
    with atomic_write(path, force=force) as temporary:
        if is_image:
            _write_image(table, temporary)
        else:
            title = f"uplift: {data.sensor.space} to Fourier sRGB"
            temporary.write_text(
                cube_text(table.transpose(2, 1, 0, 3), title, size),
                encoding="utf-8",
                newline="\n",
            )
        write_text(_shader(data.model, matrix, path.stem), files[1], force=force)
    return _errors(cube, table, matrix)


def _to_moments(data: CubeData) -> Array:
    """Return the matrix (3, 3) from linear Fourier sRGB to moments.

    Its inverse takes c to c₀ + S (c₁, c₂), where S minimises the distance to the RGB of
    the nodes. Rows of S are scaled down so that all nodes are in [0, 1].
    """
    moments = data.points.coefficients[data.points.present]
    rgb = data.points.rgb[data.points.present]
    slopes = np.linalg.lstsq(moments[:, 1:], rgb - moments[:, :1])[0]
    chroma = moments[:, 1:] @ slopes
    room = np.where(chroma < 0, moments[:, :1], 1 - moments[:, :1])
    size = np.abs(chroma)
    fraction = np.divide(room, size, out=np.ones_like(size), where=size > room).min(
        axis=0
    )
    return np.linalg.inv(np.vstack([np.ones(3), slopes * fraction]).T)


def _table(cube: Cube, nodes: Array, matrix: Array) -> Floats:
    """Return codes in [0, 1] (res, res, res, 3) of sRGB codes, by blue,
    green and red.
    """
    size = len(nodes)
    inverse = np.linalg.inv(matrix)
    table = np.empty((size, size, size, 3), dtype=np.float32)
    rgb = np.empty((size, size, 3))
    rgb[..., 1], rgb[..., 0] = np.meshgrid(decode(nodes), decode(nodes), indexing="ij")
    for blue, plane in zip(decode(nodes), table, strict=True):
        rgb[..., 2] = blue
        plane[:] = encode(cube.coefficients(rgb) @ inverse.T)
    return table


def _write_image(table: Floats, path: Path) -> None:
    import OpenImageIO

    image = OpenImageIO.ImageBuf(
        _codes(table).astype(np.uint8).reshape(LEVEL**3, LEVEL**3, 3)
    )
    if not image.write(str(path), "uint8", "png"):
        raise TextureError(image.geterror(), path=path)


def _codes(numbers: Values) -> Values:
    return np.rint(255 * numbers)


def _shader(model: Moments, matrix: Array, stem: str) -> str:
    rows = {
        f"row_{k}": ", ".join(map(literal, row))
        for k, row in enumerate(matrix.tolist())
    }
    constants = {
        name.lower(): literal(float(value))
        for name, value in model_constants(model).items()
    }
    terms = [
        f"{literal(a)} * tanh({literal(k)} * (wavelength - {literal(m)}))"
        for a, k, m in WARPS[model.warp]
    ]
    warp = " + ".join(terms) or "wavelength"
    return Template(read_source("fourier.glsl")).substitute(
        rows, **constants, name=identifier(stem), warp=warp
    )


def _errors(cube: Cube, table: Floats, matrix: Array) -> TableError:
    """Compare colours of the spectra of 8-bit codes with the requested colours,
    linearly between nodes.
    """
    from scipy.interpolate import RegularGridInterpolator

    sensor = cube.data.sensor
    model = cube.data.model
    assert isinstance(model, Moments)
    interpolator = RegularGridInterpolator([np.linspace(0, 1, len(table))] * 3, table)

    def error(codes: Array) -> Array:
        codes = _codes(codes) / 255
        moments = decode(_codes(interpolator(codes[:, ::-1])) / 255) @ matrix.T
        multipliers, valid = multipliers_of_rounded(model, moments)
        multipliers[~valid] = 0  # medium grey: the error is not understated
        spectra = evaluate(model, multipliers, sensor.wavelengths)
        return delta_e_rgb(sensor, sensor.rgb(spectra), decode(codes))

    return find_errors(error, cube.data.atlas.rgb)
