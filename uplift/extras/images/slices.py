"""Cubes as OpenEXR slices: all numbers of all nodes, one part per blue slice."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import StrPath, Values
from uplift.common.errors import OutputError
from uplift.common.machine import check_memory
from uplift.cube.data import CubeData
from uplift.extras.images.exr import attributes, make_part, write_parts

NODE_BYTES = 220
"""Memory of a node in all images, without its coefficients."""
COMMENTS = (
    "A blue slice of a spectral uplifting cube. A pixel is a node: red rises to the "
    "right, green upwards (the top row has the highest). R, G, B and lattice: what "
    "the stored spectrum evaluates to; target: the node itself, both linear. "
    "distance: largest difference of the two. entry and round: -1 for none. Absent "
    "nodes, of a cube built for a scene, hold nothing but their status."
)
"""The ``comments`` attribute of every part."""


def write_slices(data: CubeData, path: StrPath, *, force: bool = False) -> None:
    """Write a cube as one OpenEXR file with a part ``blue 07 (0.1234)`` for every node
    of the blue axis.

    Pixel x is the red index. Row y is the green index dim − 1 − y, so that green rises
    upwards. The channels are 32-bit floats: ``R``, ``G``, ``B`` and ``lattice.*``
    (lattice RGB), ``target.*``, ``distance``, ``deltaE2000`` (target to lattice RGB
    under the build illuminant), ``status``, ``entry`` and ``round`` (−1 for none;
    ``round`` only with debug information), ``standardError`` (of cubes with an atlas)
    and ``coefficient.00`` onwards. Raises `OutputError`.
    """
    if Path(path).suffix.lower() != ".exr":
        raise OutputError(
            "the name of a file of slices must end in .exr",
            path=path,
            hint="name the file .exr, or write a contact sheet",
        )
    check_slices(data)
    write_parts(_parts(data), path, force=force)


def check_slices(data: CubeData) -> None:
    """Raise `OutputError` if the images of all nodes, of which a sparse cube has few,
    do not fit into free memory.
    """
    need = data.lattice.size * (NODE_BYTES + 4 * data.model.count)
    hint = "use a machine with more memory, or a cube of a smaller dim"
    check_memory(need, f"images of {data.lattice.dim}³ nodes", OutputError, hint)


def blue_slices(values: Values, dim: int) -> Values:
    """Arrange the values (dim³, …) of nodes as a view (dim, dim, dim, …) with axes
    blue, row, red.

    Image rows count downwards, so row 0 has the highest green: ``row = dim − 1 −
    green``.
    """
    by_red = values.reshape(dim, dim, dim, *values.shape[1:])
    return by_red.swapaxes(0, 2)[:, ::-1]


def channels(data: CubeData) -> dict[str, Values]:
    """Return the values (n,) of the nodes by channel name."""
    target = data.lattice.points
    values: dict[str, Values] = {
        **_rgb("", data.points.rgb),
        **_rgb("lattice.", data.points.rgb),
        **_rgb("target.", target),
        "distance": data.points.distance,
        "deltaE2000": np.where(
            data.points.present, delta_e_rgb(data.sensor, target, data.points.rgb), 0
        ),
        "status": data.points.status,
        "entry": data.points.entry,
    }
    if data.points.round is not None:
        values["round"] = data.points.round
    if data.points.standard_error is not None:
        values["standardError"] = data.points.standard_error
    return values | {
        f"coefficient.{i:02}": column
        for i, column in enumerate(data.points.coefficients.T)
    }


def _parts(data: CubeData) -> Iterator[Any]:
    common = {**attributes(data), "comments": COMMENTS}
    slices = {
        name: blue_slices(values, data.lattice.dim)
        for name, values in channels(data).items()
    }
    digits = len(str(data.lattice.dim - 1))
    for blue, value in enumerate(map(float, data.lattice.nodes)):
        header = {**common, "uplift.blueIndex": blue, "uplift.blueValue": value}
        name = f"blue {blue:0{max(digits, 2)}} ({value:.4f})"
        yield make_part(
            name, header, {channel: stack[blue] for channel, stack in slices.items()}
        )


def _rgb(layer: str, rgb: Values) -> dict[str, Values]:
    return {f"{layer}{letter}": rgb[:, i] for i, letter in enumerate("RGB")}
