"""The lattice over chromaticity: weights give back the chromaticity, single wavelengths
are on its rim.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from uplift.colorimetry import observer
from uplift.common.errors import OptionError
from uplift.extras.emission.fit import locus_lattice
from uplift.extras.emission.lattice import (
    LOCUS_TOLERANCE,
    ChromaticityLattice,
    chromaticity,
)

WHITE = np.array([0.2, 0.4])
KNOTS = np.array([[0.6, 0.5], [0.3, 0.6], [0.0, 0.55], [0.05, 0.2], [0.25, 0.0]])
LATTICE = ChromaticityLattice(WHITE, KNOTS, np.array([0.0, 0.3, 0.7, 1.0]))


def at(cells):
    """Chromaticities of cells by their weights of the four corners."""
    nodes = LATTICE.nodes
    after = (cells.sector + 1) % len(KNOTS)
    places = (
        nodes[cells.sector, cells.ring],
        nodes[cells.sector, cells.ring + 1],
        nodes[after, cells.ring],
        nodes[after, cells.ring + 1],
    )
    return (cells.weights[..., None] * np.stack(places, axis=1)).sum(axis=1)


@settings(max_examples=30)
@given(st.integers(0, 4), st.floats(0, 1), st.floats(0, 1))
def test_weights_give_back_the_chromaticity(sector, along, share):
    rim = (1 - along) * KNOTS[sector] + along * KNOTS[(sector + 1) % 5]
    uv = (WHITE + share * (rim - WHITE))[None]
    cells = LATTICE.locate(uv)
    assert cells.weights.min() >= 0
    assert cells.weights.sum() == pytest.approx(1)
    assert_allclose(at(cells), uv, atol=1e-12)
    assert LATTICE.contains(uv).all()


def test_chromaticities_outside_are_not_contained_and_move_to_the_rim():
    outside = WHITE + 1.5 * (KNOTS - WHITE)
    assert not LATTICE.contains(outside).any()
    assert not LATTICE.contains(np.full((1, 2), np.nan)).any()
    assert_allclose(at(LATTICE.locate(outside)), KNOTS, atol=1e-12)


def test_chromaticity_of_equal_energy():
    """CIE 015:2018: x = y = 1/3 is u′ = 4/19, v′ = 9/19."""
    assert_allclose(chromaticity(np.ones(3)), [4 / 19, 9 / 19])


@pytest.mark.parametrize(
    ("knots", "rings"),
    [(KNOTS[::-1], [0, 1]), (KNOTS, [0, 0.5, 0.5, 1]), (KNOTS, [0, 0.9])],
)
def test_invalid_lattices_are_refused(knots, rings):
    with pytest.raises(OptionError, match="a lattice over chromaticity must"):
        ChromaticityLattice(WHITE, knots, np.array(rings, dtype=float))


CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
D65 = np.array([0.1978, 0.4683])


@pytest.fixture(scope="module")
def locus():
    return locus_lattice(RADIOMETRY, D65, 96, np.linspace(0, 1, 4))


def test_spectra_of_the_rim_have_the_chromaticities_of_the_knots(locus):
    lattice, rim = locus
    assert lattice.shape == (96, 4)
    assert_allclose(chromaticity(rim @ RADIOMETRY), lattice.knots, atol=1e-12)


def test_all_mixtures_of_wavelengths_lie_within_the_bend(locus):
    visible = np.flatnonzero(RADIOMETRY.sum(axis=1) > 1e-6)
    first, second = np.meshgrid(visible, visible)
    xyz = RADIOMETRY / RADIOMETRY.sum(axis=1, keepdims=True).clip(1e-12)
    uv = chromaticity(xyz[first] + xyz[second]).reshape(-1, 2)
    share = locus[0].polar(uv - D65)[2]
    assert 1 + 1e-4 < share.max() <= 1 + LOCUS_TOLERANCE
