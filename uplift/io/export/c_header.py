"""A cube as one C99 header, which C++ takes too: table, lookup and spectra, with nothing else needed."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import OptionError, UpliftWarning
from uplift.common.files import atomic_write
from uplift.cube import CubeData, digest
from uplift.models import Model, Moments, Sigmoid
from uplift.models.phase import WARPS

LARGE = 16_000_000
"""Bytes of text that compilers take long over."""
IN_C = {"none": "wavelength", "vision": "tanh(0.0072 * (wavelength - 538.0))"}
"""`WARPS` in C."""
TYPES = {"float32": ("float", "%.9g"), "float64": ("double", "%.17g"), "int64": ("int", "%d")}


def write_c(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write the header, and say how many bytes it has. Its names begin with the file's, made an identifier.

    Spectra are interpolated as mode ``moments`` has it: coefficients, of lattice and entries alike.
    Raises `OutputError`, and `OptionError` for a cube of a scene: the header could not refuse other colours. Warns
    where the header is large.
    """
    if data.complete_cells is not None:
        problem = "the cube was built for the colours of a scene, and a header has all colours"
        raise OptionError(problem, hint="export it with --fill (in Python: cube.fill_missing())")
    name = _identifier(Path(path).stem)
    with atomic_write(path, force=force) as temporary:
        with temporary.open("w", encoding="ascii", newline="\n") as file:
            file.writelines(_parts(data, name))
        size = temporary.stat().st_size
    if size > LARGE:
        message = (
            f"{path} has {size / 1e6:.0f} MB, which compilers take long over; a cube of smaller dim has less"
        )
        warnings.warn(message, UpliftWarning, stacklevel=2)
    return size


def _identifier(stem: str) -> str:
    """'macbeth-32' → 'macbeth_32', '32' → 'cube_32'."""
    name = re.sub(r"\W+", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z]", name) else f"cube_{name}".rstrip("_")


def _parts(data: CubeData, name: str) -> Iterator[str]:
    words = _words(data, name)
    yield _template("head").substitute(words)
    yield from _array(f"{name}_nodes[]", data.lattice.nodes[:, None])
    yield from _array(f"{name}_table[][{data.model.count}]", data.points.coefficients)
    boxes = "boxes" if len(data.entry_boxes.cells[0]) else "no_boxes"
    if boxes == "boxes":
        yield from _array(f"{name}_box_cell[]", data.entry_boxes.cells[0][:, None])
        yield from _array(f"{name}_box_entry[]", data.entry_boxes.cells[1][:, None])
        yield from _array(
            f"{name}_entry_box[][9]", np.concatenate([data.atlas.rgb, *data.entry_boxes.faces], axis=1)
        )
        yield from _array(f"{name}_entry[][{data.model.count}]", data.atlas.coefficients)
    for part in ("lattice", boxes, data.model.name, "tail"):
        yield _template(part).substitute(words)


def _words(data: CubeData, name: str) -> dict[str, Any]:
    """What the templates leave open."""
    sensor = data.sensor
    facts = {
        "version": version("uplift"),
        "digest": digest(data),
        "space": _comment(sensor.space),
        "illuminant": _comment(sensor.illuminant),
        "observer": _comment(sensor.observer),
        "name": name,
        "NAME": name.upper(),
        "dim": data.lattice.dim,
        "count": data.model.count,
        "type": TYPES[data.points.coefficients.dtype.name][0],
        "entries": len(data.atlas.names),
        "boxes": len(data.entry_boxes.cells[0]),
    }
    return facts | _range(data.model)


def _comment(text: str) -> str:
    """Text that a comment can hold: whoever made the cube chose it."""
    return text.encode("ascii", "replace").decode().replace("*", "")


def _range(model: Model) -> dict[str, Any]:
    if isinstance(model, Sigmoid):
        return {"start": model.start, "end": model.end}
    assert isinstance(model, Moments)
    phase = model.phase
    low, high = WARPS[phase.warp](np.array([phase.start, phase.end])).tolist()
    return {
        "start": phase.start,
        "end": phase.end,
        "warp": IN_C[phase.warp],
        "low": repr(low),
        "width": repr(high - low),
    }


def _template(part: str) -> Template:
    return Template((files("uplift.io.export") / "templates" / f"{part}.h").read_text(encoding="ascii"))


def _array(declaration: str, rows: NDArray[Any]) -> Iterator[str]:
    """A constant array of rows (n, K), one a line, with all their digits; of plain numbers where K is 1."""
    kind, style = TYPES[rows.dtype.name]
    width = rows.shape[1]
    line = f"{style},\n" if width == 1 else "{" + ", ".join([style] * width) + "},\n"
    yield f"static const {kind} {declaration} = {{\n"
    for row in rows.tolist():
        yield line % tuple(row)
    yield "};\n\n"
