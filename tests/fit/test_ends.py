"""Black, white, the primaries and colours near them: finite, and as exact as all
others.
"""

from itertools import product

import numpy as np
import pytest

from uplift.lookup.interpolate import MODES

INSIDE = 1e-6
CORNERS = np.array(list(product((0.0, 1.0), repeat=3)))
EDGES = np.array(
    [at for at in product((0.0, 0.5, 1.0), repeat=3) if at.count(0.5) == 1]
)
ENDS = np.concatenate(
    [CORNERS, EDGES, np.abs(CORNERS - INSIDE), np.abs(EDGES - INSIDE)]
)


@pytest.fixture(params=["small_cube", "small_sigmoid_cube"])
def cube(request):
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("mode", MODES)
def test_answers_are_finite_reflectances(cube, mode):
    found = cube.reflectance(ENDS, np.arange(300.0, 900, 5), mode)
    assert ((found >= 0) & (found <= 1)).all()
    assert np.isfinite(
        cube.data.model.from_storage(cube.coefficients(ENDS))
    ).all()  # renderers evaluate multipliers


def test_colours_are_as_exact_as_the_lattice(cube):
    found = cube.data.sensor.rgb(cube.reflectance(ENDS))
    assert np.abs(found - ENDS).max() <= cube.data.threshold / 100 + 1e-8
