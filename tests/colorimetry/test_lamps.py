"""Sets of lamps."""

from __future__ import annotations

import numpy as np

from tests.helpers import raises
from uplift.colorimetry.lights import Lamps
from uplift.common.errors import UnknownNameError

LAMPS = Lamps(("A", "B", "C"), np.arange(6.0).reshape(3, 2))


def test_lamps_are_left_out_by_name():
    found = LAMPS.without(("B",))
    assert found.names == ("A", "C")
    np.testing.assert_array_equal(found.power, [[0, 1], [4, 5]])
    assert LAMPS.without(()).names == LAMPS.names


def test_an_unknown_lamp_is_refused():
    with raises(UnknownNameError, "unknown-lamp"):
        LAMPS.without(("A", "D"))
