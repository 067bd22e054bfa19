"""Queries of an emission table: exact colour, no negative power, lamps, and colours
that no light has.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.helpers import raises
from uplift.common.errors import ColourError, OptionError
from uplift.extras.emission.discs import LampEntries
from uplift.extras.emission.lattice import DENOMINATOR, chromaticity

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


def test_lookups_agree_with_a_plain_one():
    xyz = np.concatenate(
        [random_lights(40), TABLE.xyz(np.random.default_rng(1).random((20, 3)) + 0.5)]
    )
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


def test_light_scales():
    rgb = np.array([0.9, 0.5, 0.2])
    for scale in (0, 1e-20, 1e5, 1e20):
        assert_allclose(
            TABLE.spectrum(scale * rgb), scale * TABLE.spectrum(rgb), rtol=1e-12
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


def test_colours_beyond_the_bend_of_the_locus_are_lights_and_hardly_move():
    mixture = RADIOMETRY[39] + RADIOMETRY[46]  # 575 and 610 nm
    power = TABLE.spectrum_of_xyz(mixture)
    assert TABLE.contains(TABLE.rgb_of_xyz(mixture))
    assert power @ RADIOMETRY[:, 1] == pytest.approx(mixture[1])
    assert (
        1e-6
        < np.linalg.norm(chromaticity(power @ RADIOMETRY) - chromaticity(mixture))
        < 1e-4
    )


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


def test_colours_of_no_light_are_errors():
    for rgb in ([-0.5, 1.0, -0.5], [-1.0, -1.0, -1.0], [0.0, -1e-3, 0.0]):
        assert not TABLE.contains(rgb)
        with raises(ColourError, "colour-not-a-light"):
            TABLE.spectrum(rgb)
        with raises(ColourError, "colour-not-a-light"):
            TABLE.expected_error(rgb)


def test_contains_agrees_with_mixtures_of_wavelengths():
    """The realisable colours are those of non-negative powers; the others have a
    positive distance from them.
    """
    from scipy.optimize import nnls

    rng = np.random.default_rng(3)
    rgb = rng.uniform(-0.6, 1.2, (60, 3))
    found = TABLE.contains(rgb)
    reach = np.array([nnls(RADIOMETRY.T, xyz)[1] for xyz in TABLE.xyz(rgb)])
    assert 10 < found.sum() < 50
    assert_array_equal(found, reach < 1e-9)


def test_wavelengths_are_interpolated_linearly():
    rgb = [0.9, 0.5, 0.2]
    stored = TABLE.spectrum(rgb)
    found = TABLE.spectrum(rgb, [380, 382.5, 500, 780])
    expected = [stored[0], stored[:2].mean(), stored[24], stored[-1]]
    assert_allclose(found, expected, rtol=1e-12)


def test_single_precision_is_close():
    rgb = np.random.default_rng(0).random((50, 3)) * 1e4
    found = TABLE.spectrum(rgb.astype(np.float32), dtype=np.float32)
    assert found.dtype == np.float32
    assert_allclose(found, TABLE.spectrum(rgb.astype(np.float32)), rtol=1e-6)


@pytest.mark.parametrize(
    ("code", "kind", "rgb", "options"),
    [
        ("colour", ColourError, [np.nan, 0, 0], {}),
        ("colour", ColourError, [np.inf, 0, 0], {"outside": "clip"}),
        ("colour", ColourError, [1e200, 0, 0], {}),
        ("colour", ColourError, [1, 2], {}),
        ("colour", ColourError, ["a", 1, 1], {}),
        ("option", OptionError, [1, 1, 1], {"outside": "wrap"}),
        ("option", OptionError, [1, 1, 1], {"wavelengths": [-5]}),
        ("option", OptionError, [1, 1, 1], {"dtype": int}),
        ("option", OptionError, [1, 1, 1], {"threads": 0}),
    ],
)
def test_bad_input_is_refused(code, kind, rgb, options):
    with raises(kind, code):
        TABLE.spectrum(rgb, **options)


def test_discs_are_those_of_a_comparison_with_all():
    """Discs in and across bins: a row of small ones, which share a bin, a large one,
    and one at the edge.
    """
    uv = np.array(
        [[0.2 + 4e-4 * step, 0.5] for step in range(9)] + [[0.4, 0.3], [0.0, 0.4]]
    )
    lamps = LampEntries(
        tuple("abcdefghijk"), uv, np.ones((11, 3)), np.array([2e-4] * 9 + [0.05, 0.01])
    )
    rng = np.random.default_rng(0)
    near = (
        uv[rng.integers(0, 11, 3000)]
        + rng.normal(size=(3000, 2)) * lamps.radius[rng.integers(0, 11, 3000), None]
    )
    queried = np.concatenate([uv, near, [[-10.0, 10.0], [10.0, -10.0], [0.9, 0.9]]])
    hits = lamps.locate(queried)
    distance = np.linalg.norm(queried[:, None] - uv, axis=-1)
    rows, entry = np.nonzero(distance < lamps.radius)
    assert 500 < len(rows) < 2500
    assert_array_equal(hits.rows, rows)
    assert_array_equal(hits.entry, entry)
    assert_allclose(
        hits.share, 1 - distance[rows, entry] / lamps.radius[entry], atol=1e-9
    )
    assert_array_equal(hits.share[:11], 1)
    assert_allclose(
        np.linalg.norm(hits.exit_uv - uv[entry], axis=1), lamps.radius[entry]
    )
    nobody = LampEntries((), np.empty((0, 2)), np.empty((0, 3)), np.empty(0))
    assert not nobody.locate(np.full((4, 2), 0.3)).rows.size
