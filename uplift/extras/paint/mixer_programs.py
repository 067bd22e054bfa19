"""Mixers of RGB as programs: a C header, GLSL with a texture, and a JavaScript module.

Their sources are ``mixer.*`` in ``uplift/extras/export/source``. ``up_`` and ``UP_`` in
them become the name of the program.
"""

import base64
from collections.abc import Callable
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev

from uplift.common.arrays import Array, StrPath, Values
from uplift.common.errors import unknown_name
from uplift.common.files import atomic_write, write_text
from uplift.common.text import round_up
from uplift.common.version import version
from uplift.cube.data import CubeData
from uplift.cube.file import digest
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export.outputs import output_files
from uplift.extras.export.source import (
    comment,
    literal,
    name_program,
    read_source,
)
from uplift.extras.files.outputs import check_outputs
from uplift.extras.paint.bands import BANDS
from uplift.extras.paint.rgb_mixer import DIM, RgbMixer, make_mixer
from uplift.lookup.cube import Cube

LINEAR_END = 0.0031308
"""Largest linear value on the straight part of the curve of sRGB."""
CURVE_DEGREE = 5
QUARTER = BANDS // 2
"""Numbers of a node in a texel."""
Words = dict[str, Any]


def export(cube: Cube, path: Path, style: str, *, force: bool, res: int = DIM) -> str:
    """Write a mixer of the colours of a cube."""
    files = write_mixer(cube, path, style=style, res=res, force=force)
    size = sum(file.stat().st_size for file in files) / 1e3
    facts = [f"mixer of RGB as paints, {res}³ nodes of {BANDS} bands", f"{size:.0f} kB"]
    facts += [f"table in {file}" for file in files[1:]]
    return ", ".join(facts)


def write_mixer(
    cube: Cube,
    path: StrPath,
    *,
    style: str = "mixer-c",
    res: int = DIM,
    force: bool = False,
) -> list[Path]:
    """Write a program that mixes RGB colours as paints; return its files.

    Parameters
    ----------
    cube : Cube
        The cube, with all nodes.
    path : path-like
        The program. Names in it begin with that of the file.
    style : {"mixer-c", "mixer-glsl", "mixer-js"}
        A header of C99 and C++, a shader with a table of half floats next to it, or an
        ES module.
    res : int
        Nodes of the table along each axis, 2 to 65.
    force : bool
        Replace existing files.

    Returns
    -------
    list of Path
        The program, and the table of a shader.

    Raises
    ------
    UnknownNameError
        The style does not exist.
    OptionError
        ``res`` is out of range, or the cube was built for a scene.
    OutputError
        A file exists.
    """
    if style not in STYLES:
        raise unknown_name(style, STYLES, "style of mixers")
    source, words_of = STYLES[style]
    files = output_files(path, style)
    check_outputs(files, force=force)
    mixer = make_mixer(cube, res)
    words = words_of(mixer) | _facts(cube.data, mixer, files[0])
    text = Template(read_source(source)).substitute(words)
    for table in files[1:]:
        with atomic_write(table, force=force) as temporary:
            temporary.write_bytes(texture(mixer).tobytes())
    write_text(name_program(text, files[0].stem), files[0], force=force)
    return files


def _facts(data: CubeData, mixer: RgbMixer, path: Path) -> Words:
    """Return the words of all programs."""
    sensor = data.sensor
    return {
        "version": version(),
        "digest": digest(data),
        "space": comment(sensor.space),
        "illuminant": comment(sensor.illuminant),
        "observer": comment(sensor.observer),
        "stem": comment(path.stem),
        "file": comment(path.name),
        "dim": len(mixer.table),
        "bands": BANDS,
    }


def _c_words(mixer: RgbMixer) -> Words:
    nodes = mixer.table.reshape(-1, 2 * BANDS).tolist()
    coefficients, error = _curve()
    curve = literal(coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        curve = f"({curve} * v + {literal(coefficient)})"
    return {
        "numbers": "".join(", ".join(map(str, node)) + ",\n" for node in nodes),
        "units": ", ".join(map(literal, mixer.units[[0, BANDS]].tolist())),
        "to_rgb": "".join(f"    {{{_listed(row)}}},\n" for row in mixer.to_rgb),
        "decoded": _listed(decode(np.arange(256) / 255)) + ",\n",
        "curve": curve,
        "curve_error": f"{round_up(error):g}",
    }


def _curve() -> tuple[list[float], float]:
    """Return the coefficients, constant first, of codes of 8 bits as a polynomial of
    the fourth root of linear values, and its largest error in codes.
    """
    darkest = LINEAR_END**0.25
    curve = Chebyshev.interpolate(_codes, CURVE_DEGREE, [darkest, 1.0])
    roots = np.linspace(darkest, 1, 1000)
    error = np.abs(curve(roots) - _codes(roots)).max()
    return curve.convert(kind=np.polynomial.Polynomial).coef.tolist(), float(error)


def _codes(roots: Array) -> Array:
    return 255 * encode(roots**4)


def _listed(numbers: Array) -> str:
    return ", ".join(map(literal, numbers.tolist()))


def _js_words(mixer: RgbMixer) -> Words:
    rows = [", ".join(map(repr, row)) for row in mixer.to_rgb.tolist()]
    return {
        "numbers": base64.b64encode(mixer.table.astype("<u2").tobytes()).decode(),
        "units": ", ".join(map(repr, mixer.units[[0, BANDS]].tolist())),
        "to_rgb": "".join(f"  [{row}],\n" for row in rows),
    }


def _glsl_words(mixer: RgbMixer) -> Words:
    quarters = mixer.to_rgb.reshape(-1, QUARTER).tolist()
    texels = [", ".join(map("{:.9f}".format, quarter)) for quarter in quarters]
    return {
        "to_rgb": ",\n".join(f"    vec4({texel})" for texel in texels),
        "depth": len(mixer.table) * 2 * BANDS // QUARTER,
    }


def texture(mixer: RgbMixer) -> Values:
    """Return the table as half floats (2 * BANDS / 4 * dim, dim, dim, 4): quarters of
    the numbers one after another, each by red, green and blue.
    """
    roots = mixer.table * mixer.units
    quarters = np.split(roots, 2 * BANDS // QUARTER, axis=-1)
    return np.concatenate(quarters).astype("<f2")


STYLES: dict[str, tuple[str, Callable[[RgbMixer], Words]]] = {
    "mixer-c": ("mixer.h", _c_words),
    "mixer-glsl": ("mixer.glsl", _glsl_words),
    "mixer-js": ("mixer.mjs", _js_words),
}
"""Source of each style, and its words."""
