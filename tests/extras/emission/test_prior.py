"""Lights expected at chromaticities, near lamps where there are any."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.extras.emission.fit import nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.prior import fit_lamp_prior, smoothest_lights

CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
LAMPS = known_lamps()
SURFACES = on_grid(read_atlas("macbeth"), observer.grid())


@pytest.fixture(scope="module")
def fitted():
    return fit_lamp_prior(LAMPS.power, SURFACES, RADIOMETRY)


def test_left_out_predictions_do_not_know_the_lamp(fitted):
    """A plain kriging of the others gives the same light, before it is moved to the
    chromaticity.
    """
    prior, left_out = fitted
    row = LAMPS.names.index("FL11")
    others = np.arange(len(LAMPS)) != row
    power = LAMPS.power / (LAMPS.power @ RADIOMETRY @ (1, 15, 3))[:, None]
    smooth = smoothest_lights(prior.uv, RADIOMETRY)
    known = prior.uv[others]
    covariance = prior.kernel(known, known) + prior.kernel.nugget * np.eye(len(known))
    weights = np.linalg.solve(covariance, prior.kernel(known, prior.uv[[row]])[:, 0])
    expected = smooth[row] + weights @ (power - smooth)[others]
    expected = np.maximum(expected, 1e-3 * smooth[row])
    found = nearest_lights(expected[None], prior.uv[[row]], RADIOMETRY)
    assert_allclose(found[0], left_out[row], atol=1e-6)


def test_deviations_grow_with_the_distance_from_lamps(fitted):
    prior = fitted[0]
    near, far = prior.standard_deviation(np.array([prior.uv[0], [0.05, 0.58]]))
    assert 0 < near < far <= 1
