"""Surfaces against Fresnel's equations integrated, and published figures."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import OptionError
from uplift.design.mixing import surface

INDICES = (1.01, 1.2, 1.5, 1.66, 2.4)


def integrated(n):
    """Fresnel's reflectance of unpolarised light over the hemisphere, by the midpoint rule."""
    cosine = (np.arange(200_000) + 0.5) / 200_000
    inner = np.sqrt(1 - (1 - cosine**2) / n**2)
    s = (cosine - n * inner) / (cosine + n * inner)
    p = (n * cosine - inner) / (n * cosine + inner)
    return float(((s**2 + p**2) / 2 * 2 * cosine).mean())


@pytest.mark.parametrize("n", INDICES)
def test_duntley_s_formula_is_fresnel_integrated(n):
    assert surface.diffuse(n) == pytest.approx(integrated(n), abs=1e-8)


def test_the_printed_slip_would_be_noticed():
    n = 1.5
    printed = surface.diffuse(n) + (n - 1) * (3 * n + 1) * (1 / (8 * n + 1) - 1 / (6 * (n + 1) ** 2))
    assert printed != pytest.approx(integrated(n), abs=0.1)


def test_published_figures():
    """The thesis for an index of 1.5: 4 % (9.3) and 9 % (10.3); Judd 1942: 0.596 from inside."""
    assert surface.fresnel(1.5) == pytest.approx(0.04)
    assert surface.diffuse(1.5) == pytest.approx(0.0918, abs=5e-5)
    assert surface.inside(1.5) == pytest.approx(0.596, abs=5e-4)


def test_no_denser_no_surface():
    assert surface.perpendicular(1) == surface.overcast(1) == surface.NONE


@pytest.mark.parametrize("of", [surface.perpendicular, surface.overcast])
@pytest.mark.parametrize("n", INDICES)
def test_saunderson_and_back(of, n):
    beneath = np.linspace(0, 1, 101)
    seen = of(n).seen(beneath)
    np.testing.assert_allclose(of(n).beneath(seen), beneath, atol=1e-12)
    assert (np.diff(seen) > 0).all()
    assert seen[0] == of(n).outside
    assert seen[-1] == pytest.approx(1)  # a perfect white stays one: nothing absorbs


def test_without_a_surface_nothing_changes():
    np.testing.assert_array_equal(surface.NONE.seen([0, 0.3, 1]), [0, 0.3, 1])


def test_darker_than_the_surface_is_below_0_beneath():
    assert surface.perpendicular(1.5).beneath(0.03) < 0


@pytest.mark.parametrize("n", [0.9, np.nan, np.inf])
def test_thinner_than_air_is_refused(n):
    for of in (surface.fresnel, surface.diffuse, surface.inside):
        with pytest.raises(OptionError, match="index of refraction"):
            of(n)


@pytest.mark.parametrize("values", [(1, 0), (0, 1), (-0.1, 0), (np.nan, 0)])
def test_a_mirror_is_no_surface_of_paint(values):
    with pytest.raises(OptionError, match="surface"):
        surface.Surface(*values)
