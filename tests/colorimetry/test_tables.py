"""The shipped tables are those of the installed colour-science, number by number."""

import subprocess
import sys

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from tools.ship_tables import tables as expected
from uplift.colorimetry import tables
from uplift.common.errors import UnknownNameError


def test_the_file_has_the_numbers_of_colour_science():
    arrays = expected()
    with np.load(tables.PATH) as stored:
        assert set(stored) == set(arrays)
        for name, values in arrays.items():
            if values.dtype.kind == "U":
                assert_array_equal(stored[name], values, err_msg=name)
            else:  # instruction sets round interpolated values and powers differently
                assert_allclose(
                    stored[name], values, rtol=1e-12, atol=1e-14, err_msg=name
                )


def test_what_the_file_lacks_comes_from_colour_science():
    """Other ranges, other kinds, and names in other capitals."""
    wide = tables.samples("illuminant", "D65", 360.0, 830.0, 1.0)
    assert_array_equal(wide[20:421:5], tables.samples("illuminant", "D65"))
    assert tables.samples("display", "Typical CRT Brainard 1997").shape == (81, 3)
    assert tables.rgb_space("SRGB").name == "sRGB"
    assert (
        tables.stated_name("observer", "cie_10_1964")
        == "CIE 1964 10 Degree Standard Observer"
    )
    assert tables.rgb_space("no space") is None
    with raises(UnknownNameError, "unknown-name"):
        tables.samples("illuminant", "no lamp")


def test_a_build_does_not_import_colour_science():
    code = (
        "import sys, warnings; warnings.simplefilter('ignore'); import uplift; "
        "uplift.build('macbeth', dim=2); "
        "found = {'colour', 'matplotlib', 'PIL', 'PyOpenColorIO'} & set(sys.modules); "
        "assert not found, found"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
