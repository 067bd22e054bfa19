"""Assertions on errors and warnings by their stable codes; quiet builds; cubes with
changed or absent nodes.
"""

import contextlib
import subprocess
import sys
import warnings
from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import uplift
from uplift.common.errors import UpliftError, UpliftWarning
from uplift.cube.data import CubeData
from uplift.cube.schema import POINTS
from uplift.extras.colour.query import locate_xyz, query_blocks
from uplift.lattice.point_table import ABSENT_VALUES
from uplift.lookup.cube import Cube


@contextlib.contextmanager
def raises(kind: type[UpliftError], code: str = "") -> Iterator[Any]:
    """Expect an error of ``kind``, with ``code`` if it is given; yields pytest's
    ``ExceptionInfo``.
    """
    with pytest.raises(kind) as caught:
        yield caught
    assert not code or caught.value.code == code, f"{caught.value.code}: {caught.value}"


@contextlib.contextmanager
def warns(*codes: str) -> Iterator[list[UpliftWarning]]:
    """Expect exactly the `UpliftWarning` codes given, in any order; yields the list
    that the block fills.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found: list[UpliftWarning] = []
        yield found
    found += [
        each.message for each in caught if isinstance(each.message, UpliftWarning)
    ]
    assert sorted(each.code for each in found) == sorted(codes)


def output_of(*words: object, **options: Any) -> str:
    """Run a process and return what it prints."""
    done = subprocess.run(
        list(map(str, words)), capture_output=True, text=True, **options
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def run_python(code: str, *words: object, **options: Any) -> str:
    """Run code in a new process and return what it prints."""
    return output_of(sys.executable, "-c", code, *words, **options).strip()


def quiet_build(*args: Any, **options: Any) -> Cube:
    """Build a cube without the warnings about its entries."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return uplift.build(*args, **options)


def with_points(data: CubeData, **arrays: Any) -> CubeData:
    """Return ``data`` with some arrays of its table of nodes replaced."""
    return replace(data, points=replace(data.points, **arrays))


def without_evidence(cube: Cube) -> Cube:
    """A cube as earlier versions wrote it, without left-out materials and errors."""
    atlas = replace(cube.data.atlas, measured=None, left_out=None)
    data = with_points(cube.data, standard_error=None)
    return Cube(replace(data, atlas=atlas, families=None))


def with_absent_points(data: CubeData, present: np.ndarray) -> CubeData:
    """Return the cube with the nodes ``present`` (dim³,) only, as a build for a scene
    returns it.
    """
    arrays = {name: getattr(data.points, name) for name in POINTS}
    arrays = {name: array.copy() for name, array in arrays.items() if array is not None}
    for name, array in arrays.items():
        array[~present] = ABSENT_VALUES.get(name, 0)
    return with_points(data, **arrays)


def near_black(data: CubeData) -> np.ndarray:
    """Mask (dim³,) of the nodes in the lowest quarter of every axis."""
    position = data.lattice.position(np.arange(data.lattice.size))
    return (position <= data.lattice.dim // 4).all(axis=1)


def query(cube, rgb, wavelengths=None, mode="spectra", **options):
    """The answers to colours in full detail, one by one."""
    for block in query_blocks(cube, np.asarray(rgb), wavelengths, mode, **options):
        for row, entry in enumerate(block.entry):
            yield SimpleNamespace(
                rgb=block.rgb[row],
                reflectance=block.reflectance[row],
                round_trip=block.round_trip[row],
                delta_e_2000=block.delta_e_2000[row],
                xyz=block.xyz[row],
                cell=block.cell[row],
                statuses=block.statuses[row],
                entry=entry,
                errors=block.errors[row].tolist(),
                light_errors={
                    n: x[row].tolist() for n, x in block.light_errors.items()
                },
                realisable=block.realisable[row],
            )


def query_xyz(cube, xyz, lights=()):
    """The answers to colours by XYZ."""
    rgb, requested, outside = locate_xyz(cube, xyz)
    return list(
        query(cube, rgb, requested_rgb=requested, outside=outside, lights=lights)
    )
