"""The rim of the lattice over chromaticity: single wavelengths, also where the spectral locus bends inward."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.lights.fit import locus_lattice
from uplift.lights.lattice import BEND, chromaticity

CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
AT = observer.grid()
WHITE = np.array([0.1978, 0.4683])


@pytest.fixture(scope="module")
def found():
    return locus_lattice(RADIOMETRY, WHITE, 96, np.linspace(0, 1, 4))


def test_spectra_of_the_rim_have_the_chromaticities_of_the_knots(found):
    lattice, rim = found
    assert lattice.shape == (96, 4)
    np.testing.assert_allclose(chromaticity(rim @ RADIOMETRY), lattice.knots, atol=1e-12)


@pytest.mark.parametrize("wavelength", range(450, 635, 5))
def test_single_wavelengths_are_knots(found, wavelength):
    """The convex polygon has none between 575 and 610 nm."""
    power = found[1][:, np.searchsorted(AT, wavelength)]
    alone = (power > 0) & (power == found[1].sum(axis=1))
    assert alone.sum() == 1


def test_all_mixtures_of_wavelengths_lie_within_the_bend(found):
    visible = np.flatnonzero(RADIOMETRY.sum(axis=1) > 1e-6)
    first, second = np.meshgrid(visible, visible)
    xyz = RADIOMETRY / RADIOMETRY.sum(axis=1, keepdims=True).clip(1e-12)
    uv = np.concatenate([chromaticity(xyz[first] * part + xyz[second]).reshape(-1, 2) for part in (0.3, 1, 3)])
    share = found[0].polar(uv - WHITE)[2]
    assert 1 + 1e-4 < share.max() <= 1 + BEND
