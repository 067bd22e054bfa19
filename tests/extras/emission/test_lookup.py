"""Queries of an emission table: exact colour, no negative power, lamps, and colours
that no light has.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import nnls

import uplift
from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.extras.emission.lattice import DENOMINATOR

TABLE = uplift.load_emission()
RADIOMETRY = TABLE.data.cmfs / TABLE.data.cmfs[:, 1].sum()


def random_lights(count):
    """XYZ of random mixtures of few wavelengths, which cover the spectral locus, of
    many brightnesses.
    """
    rng = np.random.default_rng(0)
    power = rng.random((count, 81)) ** 40 * 10.0 ** rng.uniform(-4, 5, (count, 1))
    return power @ RADIOMETRY


def plain_spectrum(xyz):
    """A slow lookup of one colour: the triangles of all cells are tried one by one."""
    data = TABLE.data
    size = xyz @ DENOMINATOR
    uv = xyz[:2] * (4, 9) / size
    share = 0.0
    entry = 0
    for number, (centre, radius) in enumerate(
        zip(data.entries.uv, data.entries.radius, strict=True)
    ):
        distance = np.linalg.norm(uv - centre)
        if distance < radius:
            share = 1 - distance / radius
            entry = number
            uv = centre + (uv - centre) * radius / distance
            break
    nodes = data.lattice.nodes
    knots, rings = data.lattice.shape
    for k in range(knots):
        following = (k + 1) % knots
        spokes = (
            np.stack([nodes[k, -1], nodes[following, -1]], axis=1)
            - data.lattice.white[:, None]
        )
        a, b = np.linalg.solve(spokes, uv - data.lattice.white)
        if a < 0 or b < 0:
            continue
        j = min(int(np.sum(data.lattice.rings <= a + b)) - 1, rings - 2)
        low, high = data.lattice.rings[[j, j + 1]]
        t = b / (a + b)
        s = (a + b - low) / (high - low)
        inner = (1 - t) * data.spectra[k, j] + t * data.spectra[following, j]
        outer = (1 - t) * data.spectra[k, j + 1] + t * data.spectra[following, j + 1]
        lattice = (1 - s) * inner + s * outer
        return size * ((1 - share) * lattice + share * data.entries.spectra[entry])
    raise AssertionError("no cell")


def lights_near_lamps(count):
    """XYZ of lights in and around the discs of lamps."""
    entries = TABLE.data.entries
    rng = np.random.default_rng(1)
    lamp = rng.integers(0, len(entries.names), count)
    uv = entries.uv[lamp]
    uv = uv + rng.uniform(-1, 1, uv.shape) * entries.radius[lamp, None]
    u, v = uv.T
    return np.stack([9 * u, 4 * v, 12 - 3 * u - 20 * v], axis=1)


def test_lookups_agree_with_a_plain_one():
    xyz = np.concatenate([random_lights(30), lights_near_lamps(60)])
    found = TABLE.spectrum_of_xyz(xyz)
    for row, power in zip(xyz, found, strict=True):
        assert_allclose(power, plain_spectrum(row), rtol=1e-9, atol=1e-9 * power.max())


def test_colours_are_exact_and_powers_are_not_negative():
    xyz = random_lights(5000)
    power = TABLE.spectrum_of_xyz(xyz)
    assert power.min() >= 0
    size = xyz @ DENOMINATOR
    assert np.abs(power @ RADIOMETRY - xyz).max(axis=1) / size == pytest.approx(
        0, abs=2e-7
    )


def test_lamps_are_exact_at_their_colours():
    entries = TABLE.data.entries
    found = TABLE.spectrum_of_xyz(entries.spectra @ RADIOMETRY)
    assert_allclose(found, entries.spectra, rtol=1e-6, atol=1e-9)


def test_single_wavelengths_are_themselves():
    """At 590 nm, near the lamps of low pressure sodium, a mixture of yellow and red has
    nearly the same colour.
    """
    rows = np.searchsorted(TABLE.wavelengths, [470, 530, 590, 600])
    assert_allclose(
        TABLE.spectrum_of_xyz(RADIOMETRY[rows]), np.eye(81)[rows], atol=1e-5
    )


@settings(max_examples=40)
@given(st.tuples(*[st.floats(-1, 1, allow_subnormal=False)] * 3))
def test_clipped_colours_are_lights_of_the_same_luminance(rgb):
    power = TABLE.spectrum(rgb, outside="clip")
    assert power.min() >= 0
    luminance = TABLE.xyz(rgb)[1]
    assert power @ RADIOMETRY[:, 1] == pytest.approx(max(luminance, 0), abs=1e-6)
    if TABLE.contains(rgb):
        assert_array_equal(power, TABLE.spectrum(rgb))
    elif luminance > 0:  # on the way to white
        moved, requested = np.array([TABLE.rgb(power), rgb]) - luminance
        moved, requested = np.array([moved, requested]) / np.abs(requested).max()
        assert_allclose(np.cross(moved, requested), 0, atol=1e-5)
        assert 0 < moved @ requested < requested @ requested


def test_contains_agrees_with_mixtures_of_wavelengths():
    """The realisable colours are those of non-negative powers; the others have a
    positive distance from them.
    """
    rng = np.random.default_rng(3)
    rgb = rng.uniform(-0.6, 1.2, (60, 3))
    found = TABLE.contains(rgb)
    reach = np.array([nnls(RADIOMETRY.T, xyz)[1] for xyz in TABLE.xyz(rgb)])
    assert 10 < found.sum() < 50
    assert_array_equal(found, reach < 1e-9)


def test_wavelengths_are_interpolated_linearly():
    rgb = [0.9, 0.5, 0.2]
    stored = TABLE.spectrum(rgb)
    found = TABLE.spectrum(rgb, [380, 382.5, 780], dtype=np.float32)
    assert found.dtype == np.float32
    assert_allclose(found, [stored[0], stored[:2].mean(), stored[-1]], rtol=1e-6)


@pytest.mark.parametrize(
    "rgb",
    [
        [np.nan, 0, 0],
        [1e200, 0, 0],
        [1, 2],
        ["a", 1, 1],
        [-0.5, 1.0, -0.5],
        [0.0, -1e-3, 0.0],
    ],
)
def test_bad_colours_are_refused(rgb):
    with raises(ColourError):
        TABLE.spectrum(rgb)
    with raises(ColourError):
        TABLE.expected_error(rgb)


@pytest.mark.parametrize(
    "options", [{"outside": "wrap"}, {"wavelengths": [-5]}, {"dtype": int}]
)
def test_bad_options_are_refused(options):
    with raises(OptionError, "option"):
        TABLE.spectrum([1, 1, 1], **options)
