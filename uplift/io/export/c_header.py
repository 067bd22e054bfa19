"""A cube as a self-contained header for C99 and C++: table, lookup, and evaluation of spectra."""

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
"""Size in bytes above which compilation is slow."""
WARPS_IN_C = {"none": "wavelength", "vision": "tanh(0.0072 * (wavelength - 538.0))"}
"""`uplift.models.phase.WARPS` as C expressions."""
TYPES = {"float32": ("float", "%.9g"), "float64": ("double", "%.17g"), "int64": ("int", "%d")}


def write_c(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write a cube as a C header.

    Names in the header begin with the name of the file, converted to an identifier. Coefficients of nodes and entries
    are interpolated, as by `Cube.coefficients`. Entries have as many coefficients as nodes here: the colours of entries
    are exact, and their spectra those of `AtlasTable.coefficients`, not the closer ones of `CubeData.entry_spectra`.

    Parameters
    ----------
    data : CubeData
        A cube with all nodes.
    path : path-like
        File to write.
    force : bool
        Whether to replace an existing file.

    Returns
    -------
    int
        Size of the header in bytes.

    Raises
    ------
    OptionError
        The cube was built for a scene; the header could not reject other colours (code ``sparse-cube``).
    OutputError
        The file cannot be written, or exists and ``force`` is off.

    Warns
    -----
    UpliftWarning
        The header is large (code ``large-header``).
    """
    if data.complete_cells is not None:
        raise OptionError(
            "a header needs all nodes, but the cube was built for the colours of a scene",
            code="sparse-cube",
            hint="pass cube.fill_missing().data",
        )
    name = _identifier(Path(path).stem)
    with atomic_write(path, force=force) as temporary:
        with temporary.open("w", encoding="ascii", newline="\n") as file:
            file.writelines(_parts(data, name))
        size = temporary.stat().st_size
    if size > LARGE:
        problem = f"the header has {size / 1e6:.0f} MB and is slow to compile"
        warning = UpliftWarning(problem, code="large-header", path=path, hint="use a cube of smaller dim")
        warnings.warn(warning, stacklevel=2)
    return size


def _identifier(stem: str) -> str:
    """Convert a file name to an identifier: 'macbeth-32' → 'macbeth_32', '32' → 'cube_32'."""
    name = re.sub(r"\W+", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z]", name) else f"cube_{name}".rstrip("_")


def _parts(data: CubeData, name: str) -> Iterator[str]:
    """Yield the text of the header piece by piece."""
    words = _placeholders(data, name)
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


def _placeholders(data: CubeData, name: str) -> dict[str, Any]:
    """Return the values of the templates' placeholders."""
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
    """Return text that cannot end a C comment; names in a cube file are arbitrary."""
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
        "warp": WARPS_IN_C[phase.warp],
        "low": repr(low),
        "width": repr(high - low),
    }


def _template(part: str) -> Template:
    return Template((files("uplift.io.export") / "templates" / f"{part}.h").read_text(encoding="ascii"))


def _array(declaration: str, rows: NDArray[Any]) -> Iterator[str]:
    """Yield a constant array, one line per row (n, K), in full precision. Rows of one number are not bracketed."""
    kind, style = TYPES[rows.dtype.name]
    width = rows.shape[1]
    line = f"{style},\n" if width == 1 else "{" + ", ".join([style] * width) + "},\n"
    yield f"static const {kind} {declaration} = {{\n"
    for row in rows.tolist():
        yield line % tuple(row)
    yield "};\n\n"
