"""Every valid cube is read back unchanged and written again as the same bytes."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_array_equal

from tests.cube.hand_made import hand_made
from uplift.cube.file import contents, digest, read, write
from uplift.cube.schema import PROVENANCE

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


@st.composite
def cubes(draw):
    names = draw(st.lists(TEXT, min_size=2, max_size=2, unique=True))
    error = draw(arrays(float, 2, elements=st.floats(0, 1e30)))
    points = replace(
        DATA.points,
        coefficients=draw(arrays(float, (8, 3), elements=NUMBERS)),
        distance=draw(arrays(np.float32, 8, elements=st.floats(0, 1024, width=32))),
        round=draw(st.sampled_from([None, DATA.points.round])),
        standard_error=draw(st.sampled_from([None, DATA.points.standard_error])),
    )
    return replace(
        DATA,
        threshold=draw(st.floats(1e-9, 0.1)),
        atlas=replace(DATA.atlas, names=tuple(names), error=error),
        points=points,
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
    arrays, metadata = contents(data)
    others, other_metadata = contents(found)
    assert metadata == other_metadata
    assert arrays.keys() == others.keys()
    for name, array in arrays.items():
        assert array.dtype == others[name].dtype
        assert_array_equal(array, others[name], err_msg=name)
    assert digest(found) == digest(data)


@settings(max_examples=25)
@given(cubes())
def test_cubes_are_read_back_and_written_again_unchanged(data):
    check_round_trip(data)


@pytest.mark.parametrize("name", ["cyan_cube", "plain_cube", "small_sigmoid_cube"])
def test_built_cubes_are_read_back_and_written_again_unchanged(request, name):
    check_round_trip(request.getfixturevalue(name).data)
