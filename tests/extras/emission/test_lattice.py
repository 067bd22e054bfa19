"""The lattice over chromaticity: single wavelengths are on its rim; lights expected at
its nodes.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import OptionError
from uplift.extras.emission.fit import locus_lattice, nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import (
    LOCUS_TOLERANCE,
    ChromaticityLattice,
    chromaticity,
)
from uplift.extras.emission.prior import fit_lamp_prior, smoothest_lights


def test_chromaticity_of_equal_energy():
    """CIE 015:2018: x = y = 1/3 is u′ = 4/19, v′ = 9/19."""
    assert_allclose(chromaticity(np.ones(3)), [4 / 19, 9 / 19])


KNOTS = np.array([[0.6, 0.5], [0.3, 0.6], [0.0, 0.55], [0.05, 0.2], [0.25, 0.0]])


@pytest.mark.parametrize(
    ("knots", "rings"),
    [(KNOTS[::-1], [0, 1]), (KNOTS, [0, 0.5, 0.5, 1]), (KNOTS, [0, 0.9])],
)
def test_invalid_lattices_are_refused(knots, rings):
    with raises(OptionError):
        ChromaticityLattice(np.array([0.2, 0.4]), knots, np.array(rings, dtype=float))


CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
D65 = np.array([0.1978, 0.4683])


@pytest.fixture(scope="module")
def locus():
    return locus_lattice(RADIOMETRY, D65, 96, np.linspace(0, 1, 4))


def test_spectra_of_the_rim_have_the_chromaticities_of_the_knots(locus):
    lattice, rim = locus
    assert_allclose(chromaticity(rim @ RADIOMETRY), lattice.knots, atol=1e-12)


def test_all_mixtures_of_wavelengths_lie_within_the_bend(locus):
    visible = np.flatnonzero(RADIOMETRY.sum(axis=1) > 1e-6)
    first, second = np.meshgrid(visible, visible)
    xyz = RADIOMETRY / RADIOMETRY.sum(axis=1, keepdims=True).clip(1e-12)
    uv = chromaticity(xyz[first] + xyz[second]).reshape(-1, 2)
    share = locus[0].polar(uv - D65)[2]
    assert 1 + 1e-4 < share.max() <= 1 + LOCUS_TOLERANCE


LAMPS = known_lamps()


@pytest.fixture(scope="module")
def fitted():
    surfaces = on_grid(read_atlas("macbeth"), observer.grid())
    return fit_lamp_prior(LAMPS.power, surfaces, RADIOMETRY)


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
