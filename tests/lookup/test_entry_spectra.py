"""Entries with more coefficients than the nodes, in every way of looking a
colour up.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.lookup.interpolate import MODES, extended_multipliers
from uplift.models.model import evaluate, reflectance

CONTINUOUS = ("spectra", "moments", "refined")


@pytest.fixture
def data(small_cube):
    assert small_cube.coefficient_count == 9
    assert small_cube.entry_coefficient_count == 17
    return small_cube.data


def extended(data, rgb):
    """Reflectances of `extended_multipliers`, of which Mitsuba's textures consist."""
    multipliers = extended_multipliers(data, rgb)
    return evaluate(data.atlas.spectra.model, multipliers, data.sensor.wavelengths)


def lookups(cube):
    """Functions from linear RGB to reflectances, by name; all are continuous."""
    data = cube.data
    functions = {
        mode: lambda rgb, mode=mode: cube.reflectance(rgb, mode=mode)
        for mode in CONTINUOUS
    }
    functions["multipliers"] = lambda rgb: extended(data, rgb)
    for count in (9, 17):
        functions[f"{count} coefficients"] = lambda rgb, count=count: cube.coefficients(
            rgb, count
        )
    return functions


def in_boxes(data, count=20):
    """Random colours (E · count, 3) in the boxes of entries."""
    low, high = data.entry_boxes.faces
    shares = np.random.default_rng(4).random((count, *low.shape))
    return (low + shares * (high - low)).reshape(-1, 3)


@pytest.mark.parametrize("mode", MODES)
def test_an_entry_is_answered_with_all_its_coefficients(small_cube, data, mode):
    own = reflectance(
        data.atlas.spectra.model,
        data.atlas.spectra.coefficients,
        data.sensor.wavelengths,
    )
    few = reflectance(data.model, data.atlas.coefficients, data.sensor.wavelengths)
    assert np.abs(own - few).max() > 0.1
    found = small_cube.reflectance(data.atlas.rgb, mode=mode)
    assert_allclose(found, own, rtol=0, atol=1e-4 if mode == "refined" else 1e-12)
    assert_allclose(extended(data, data.atlas.rgb), own, rtol=0, atol=1e-4)


def test_spectra_in_boxes_mix_entry_and_lattice(small_cube, data):
    """One colour at a time, by the definition of docs/mathematics.md, 8."""
    at = data.sensor.wavelengths
    own = data.atlas.spectra
    for colour in in_boxes(data, 1):
        hit = data.entry_boxes.find(colour[None])
        corners, weights = data.lattice.corners(hit.exit_rgb)
        lattice = weights @ reflectance(
            data.model, data.points.coefficients[corners[0]], at
        )
        entry = reflectance(own.model, own.coefficients[hit.entry], at)
        share = hit.lattice_weight[:, None]
        expected = share * lattice + (1 - share) * entry
        assert_allclose(small_cube.reflectance(colour), expected[0], rtol=0, atol=1e-9)


def test_colours_in_boxes_are_exact(small_cube, data):
    rgb = in_boxes(data)
    for name, tolerance in (
        ("spectra", 2e-6),
        ("refined", 2e-8),
        ("multipliers", 2e-8),
        ("moments", 0.03),
    ):
        spectra = lookups(small_cube)[name](rgb)
        assert np.abs(data.sensor.rgb(spectra) - rgb).max() <= tolerance, name
        assert spectra.min() >= 0, name
        assert spectra.max() <= 1, name


def test_answers_are_continuous_across_the_faces_of_boxes(small_cube, data):
    low, high = data.entry_boxes.faces
    is_box = data.atlas.half_width > 0
    within = (low > 1e-3).all(axis=1) & (high < 1 - 1e-3).all(axis=1) & is_box
    assert within.sum() > 10
    centre = data.atlas.rgb[within]
    for face, axis in ((low[within], 0), (high[within], 2)):
        on = 0.7 * centre + 0.3 * face
        on[:, axis] = face[:, axis]
        inside, outside = (on + by * (centre - on) for by in (1e-8, -1e-8))
        assert len(data.entry_boxes.find(inside).rows) == len(on)
        for name, lookup in lookups(small_cube).items():
            one, other = lookup(inside), lookup(outside)
            assert_allclose(one, other, rtol=0, atol=1e-5, err_msg=name)


def test_more_coefficients_are_the_moments_of_the_exact_spectra(small_cube, data):
    """By a fine trapezoid rule over the phase."""
    rgb = np.concatenate([in_boxes(data, 1), np.random.default_rng(2).random((30, 3))])
    phase = np.linspace(-np.pi, 0, 4001)
    spectra = small_cube.reflectance(rgb, 380 + 400 * (phase + np.pi) / np.pi)
    moments = [
        np.trapezoid(spectra * np.cos(order * phase), phase) / np.pi
        for order in range(17)
    ]
    assert_allclose(
        small_cube.coefficients(rgb, 17), np.transpose(moments), rtol=0, atol=1e-6
    )
