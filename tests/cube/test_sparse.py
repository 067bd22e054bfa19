"""Files of sparse cubes: present nodes only, and errors for nodes without a place."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tests.cube.cube_files import forge
from tests.cube.hand_made import hand_made
from tests.helpers import (
    near_black,
    raises,
    run_python,
    with_absent_points,
    without_evidence,
)
from uplift.common import machine
from uplift.common.errors import ColourError, CubeFileError, OutputError
from uplift.cube.file import digest, read, write
from uplift.cube.schema import POINTS
from uplift.extras.images.slices import write_slices
from uplift.extras.pages.sheet import write_sheet
from uplift.lattice.lattice import CORNERS, Lattice
from uplift.lattice.point_table import Status
from uplift.lookup.cube import Cube


@pytest.fixture
def data():
    whole = hand_made(6)
    return with_absent_points(whole, near_black(whole))


def test_sparse_cubes_are_read_back_and_take_no_space_for_absent_points(data, tmp_path):
    write(data, tmp_path / "part.uplift")
    write(hand_made(6), tmp_path / "whole.uplift")
    back = read(tmp_path / "part.uplift")
    for name in POINTS:
        assert_array_equal(
            getattr(back.points, name), getattr(data.points, name), err_msg=name
        )
    assert digest(back) == digest(data)
    row = sum(np.asarray(getattr(data.points, name)[0]).nbytes for name in POINTS)
    saved = [(tmp_path / f"{name}.uplift").stat().st_size for name in ("whole", "part")]
    assert saved[0] - saved[1] == pytest.approx((6**3 - 8) * row, abs=200)


def test_corner_points_and_complete_cells_are_inverse():
    lattice = Lattice(np.linspace(0, 1, 4))
    cells = np.zeros(64, dtype=bool)
    cells[lattice.index(np.array([[0, 1, 2], [2, 2, 2]]))] = True
    points = lattice.corner_points(cells)
    assert points.sum() == 16
    assert_array_equal(lattice.complete_cells(points), cells)
    assert lattice.complete_cells(np.ones(64, dtype=bool)).sum() == 27


def points(change):
    """A change of the numbers of the present nodes."""

    def apply(tensors, metadata):
        tensors["points"] = np.ascontiguousarray(change(tensors["points"].copy()))

    return apply


def with_last(value):
    def change(numbers):
        numbers[-1] = value
        return numbers

    return points(change)


def without_a_cell(tensors, metadata):
    tensors.update({name: tensors[name][:-1] for name in (*POINTS, "points")})


def huge(tensors, metadata):
    tensors["nodes"] = np.linspace(0, 1, 600)
    metadata["dim"] = 600


CHANGES = {
    "unsorted": points(lambda numbers: numbers[::-1]),
    "beyond": with_last(6**3),
    "missing": lambda tensors, metadata: tensors.pop("points"),
    "absent": lambda tensors, metadata: tensors.update(
        status=np.full_like(tensors["status"], Status.ABSENT)
    ),
    "no feature": lambda tensors, metadata: metadata["features"].remove("sparse"),
    "no cell": without_a_cell,
    "huge": huge,
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_forged_files_are_refused(data, tmp_path, change):
    with raises(CubeFileError, "cube-file"):
        read(forge(data, tmp_path / "forged.uplift", change))


def of_dim(dim):
    """A change to the first cell of a lattice of another dim."""

    def change(tensors, metadata):
        rows = np.searchsorted(
            tensors["points"], Lattice(tensors["nodes"]).index(CORNERS)
        )
        metadata["dim"] = dim
        tensors["nodes"] = np.linspace(0, 1, dim)
        tensors["points"] = (
            Lattice(tensors["nodes"]).index(CORNERS).astype(tensors["points"].dtype)
        )
        tensors.update(
            {name: tensors[name][rows] for name in POINTS if name in tensors}
        )

    return change


@pytest.mark.skipif(
    not Path("/proc/self").exists(), reason="counts memory as Linux does"
)
def test_small_files_of_large_lattices_take_little_memory(plain_cube, tmp_path):
    data = without_evidence(plain_cube).data
    sparse = with_absent_points(data, near_black(data))
    path = forge(sparse, tmp_path / "forged.uplift", of_dim(160))
    assert path.stat().st_size < 20_000
    code = (
        "import sys, uplift\n"
        "from uplift.extras.report.measures import compute_smoothness\n"
        "cube = uplift.load(sys.argv[1]).fill_missing([[0.5, 0.5, 0.5]])\n"
        "compute_smoothness(cube.data)\n"
        "print(next(line.split()[1] for line in open('/proc/self/status') if "
        "line.startswith('VmHWM:')))"
    )
    kilobytes = int(run_python(code, path, timeout=120))
    assert kilobytes < 300 * 1024  # kB; the arrays of all nodes take 310 MB


def test_images_of_more_nodes_than_memory_are_refused(data, tmp_path, monkeypatch):
    monkeypatch.setattr(machine, "free_memory", lambda: 10_000)
    for write_images, name in ((write_slices, "a.exr"), (write_sheet, "a.png")):
        with raises(OutputError, "out-of-memory"):
            write_images(data, tmp_path / name)


def test_a_colour_without_one_of_its_four_nodes_is_not_covered(plain_cube):
    rgb = np.array([0.3, 0.2, 0.7])
    data = plain_cube.data
    corners = data.lattice.corners(rgb[None])[0][0]
    assert Cube(replace(data, points=data.points.restricted_to(corners))).covers(rgb)
    for absent in corners:
        present = corners[corners != absent]
        cube = Cube(replace(data, points=data.points.restricted_to(present)))
        assert not cube.covers(rgb)
        with raises(ColourError, "colour-not-in-scene") as caught:
            cube.reflectance(rgb)
        assert "0.3, 0.2, 0.7" in caught.value.problem
