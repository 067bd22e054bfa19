"""Every valid cube is read back unchanged and written again as the same bytes."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_array_equal

from tests.cube.hand_made import hand_made, with_outside
from uplift.cube.file import contents, digest, read, write
from uplift.cube.schema import PROVENANCE
from uplift.lattice.point_table import PointTable

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | TEXT,
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3)
    ),
    max_leaves=8,
)
UNKNOWN = TEXT.filter(lambda key: f"{key}?" not in PROVENANCE)
"""Keys of the provenance whose values may be anything."""
DATA = hand_made(2)
NUMBERS = st.floats(-1e30, 1e30)


def assert_same(one, other):
    """Both cubes have equal contents, of equal types."""
    arrays, metadata = contents(one)
    others, other_metadata = contents(other)
    assert metadata == other_metadata
    assert arrays.keys() == others.keys()
    for name, array in arrays.items():
        assert array.dtype == others[name].dtype
        assert_array_equal(array, others[name], err_msg=name)


@st.composite
def cubes(draw):
    names = tuple(draw(st.lists(TEXT, min_size=2, max_size=2, unique=True)))
    return replace(
        DATA,
        threshold=draw(st.floats(1e-9, 0.1)),
        atlas=replace(
            DATA.atlas,
            names=names,
            error=draw(arrays(float, 2, elements=st.floats(0, 1e30))),
        ),
        points=PointTable(
            coefficients=draw(arrays(float, (8, 3), elements=NUMBERS)),
            rgb=DATA.points.rgb,
            distance=draw(arrays(np.float32, 8, elements=st.floats(0, 1024, width=32))),
            status=draw(arrays(np.uint8, 8, elements=st.integers(0, 5))),
            entry=draw(arrays(np.int32, 8, elements=st.integers(-1, 1))),
            round=draw(st.none() | arrays(np.int16, 8)),
            standard_error=draw(
                st.none() | arrays(np.float32, 8, elements=st.floats(0, 128, width=32))
            ),
        ),
        error_illuminant=draw(TEXT),
        provenance=draw(st.dictionaries(UNKNOWN, JSON, max_size=3)),
    )


def check_round_trip(data):
    with tempfile.TemporaryDirectory() as folder:
        first = Path(folder, "first")
        second = Path(folder, "second")
        write(data, first)
        found = read(first)
        write(found, second)
        assert second.read_bytes() == first.read_bytes()
    assert_same(found, data)
    assert digest(found) == digest(data)


@settings(max_examples=25)
@given(cubes())
def test_cubes_are_read_back_and_written_again_unchanged(data):
    check_round_trip(data)


def test_built_cubes_are_read_back_and_written_again_unchanged(
    small_cube, small_sigmoid_cube
):
    check_round_trip(small_cube.data)
    check_round_trip(with_outside(small_cube.data))
    check_round_trip(with_outside(hand_made()))
    check_round_trip(small_sigmoid_cube.data)
