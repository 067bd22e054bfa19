"""Lights expected at chromaticities: exact, positive, near lamps where there are any;
entries in discs.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.common.arrays import distances
from uplift.extras.emission.discs import lamp_entries
from uplift.extras.emission.fit import locus_lattice, mix_with_locus, nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.emission.prior import fit_lamp_prior, smoothest_lights

CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
LAMPS = known_lamps()
SURFACES = on_grid(read_atlas("macbeth"), observer.grid())
LATTICE, RIM = locus_lattice(
    RADIOMETRY, np.array([0.1978, 0.4683]), 64, np.linspace(0, 1, 6)
)


@pytest.fixture(scope="module")
def fitted():
    return fit_lamp_prior(LAMPS.power, SURFACES, RADIOMETRY)


def test_every_node_is_exact_and_positive():
    uv = LATTICE.nodes[:, :-1].reshape(-1, 2)
    power = mix_with_locus(
        smoothest_lights(uv, RADIOMETRY), uv, LATTICE, RIM, RADIOMETRY
    )
    assert power.min() >= 0
    assert_allclose(chromaticity(power @ RADIOMETRY), uv, atol=1e-9)


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


def test_discs_do_not_overlap():
    entries, _ = lamp_entries(LAMPS.only([0]), LAMPS, LATTICE, RADIOMETRY)
    apart = distances(entries.uv, entries.uv)
    reach = entries.radius[:, None] + entries.radius
    assert (apart >= reach - 1e-12)[~np.eye(len(apart), dtype=bool)].all()
