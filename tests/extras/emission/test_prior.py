"""Lights expected at chromaticities: exact, positive, near lamps where there are any;
entries in discs.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.extras.emission.discs import Lamps, lamp_entries
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
    covariance = prior.kernel(prior.uv, prior.uv) + prior.kernel.nugget * np.eye(
        len(power)
    )
    weights = np.linalg.solve(
        covariance[np.ix_(others, others)], covariance[others, row]
    )
    expected = smooth[row] + weights @ (power - smooth)[others]
    expected = np.maximum(expected, 1e-3 * smooth[row])
    found = nearest_lights(expected[None], prior.uv[row : row + 1], RADIOMETRY)
    assert_allclose(found[0], left_out[row], atol=1e-6)


def test_deviations_grow_with_the_distance_from_lamps(fitted):
    prior = fitted[0]
    near, far = prior.standard_deviation(np.array([prior.uv[0], [0.05, 0.58]]))
    assert 0 < near < far <= 1


def test_discs_do_not_overlap_and_duplicates_are_left_out():
    twice = Lamps(("one", "other"), np.repeat(LAMPS.power[:1], 2, axis=0))
    others = Lamps(LAMPS.names[1:], LAMPS.power[1:])
    entries, duplicates = lamp_entries(twice, others, LATTICE, RADIOMETRY)
    assert duplicates == (("other", "one"),)
    assert entries.names[0] == "one"
    apart = np.linalg.norm(entries.uv[:, None] - entries.uv, axis=-1) + 9 * np.eye(
        len(entries.uv)
    )
    assert (entries.radius[:, None] + entries.radius <= apart + 1e-12).all()
