"""Invented paints are recovered from samples of them, with and without noise; samples
to measure next are new, and worth what is predicted.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.paint.invented import (
    FILMS,
    WAVELENGTHS,
    invented,
    measured,
    mixture_errors,
    plan,
)
from tests.helpers import raises, warns
from uplift.common.errors import OptionError
from uplift.extras.paint import paint_fit
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.paint_advice import advise_samples
from uplift.extras.paint.paint_fit import fit_paints
from uplift.extras.paint.paint_samples import (
    MeasuredColours,
    MeasuredSpectra,
    PaintSamples,
)


def log_errors(fitted, paints):
    """Differences (2, P, N) of log K and log S to the true ones."""
    pairs = (
        (fitted.pigments.absorption, paints.pigments.absorption),
        (fitted.pigments.scattering, paints.pigments.scattering),
    )
    return np.stack([np.log(ours / theirs) for ours, theirs in pairs])


def test_exact_films_determine_the_paints_and_their_surface(three_paints):
    """Also the unit of thickness, which opaque samples do not have."""
    samples = measured(three_paints, plan(three_paints), films=FILMS)
    fitted = fit_paints(samples)
    assert np.abs(log_errors(fitted.paints, three_paints)).max() < 0.03
    surface = fitted.paints.surface
    assert surface.outside == pytest.approx(three_paints.surface.outside, abs=1e-3)
    assert surface.inside == pytest.approx(three_paints.surface.inside, abs=5e-3)
    assert mixture_errors(fitted.paints, three_paints).mean() < 0.03
    assert fitted.delta_e.max() < 0.1


def test_noise_is_within_the_stated_errors(three_paints, fitted):
    assert mixture_errors(fitted.paints, three_paints).mean() < 0.2
    stated = fitted.paints.errors
    errors = np.abs(log_errors(fitted.paints, three_paints))
    within = errors < 2 * np.stack([stated.absorption, stated.scattering])
    assert within.mean() > 0.85


def test_the_order_of_samples_and_paints_does_not_matter(three_paints, opaque_fit):
    order = [2, 0, 1]
    shares = plan(three_paints)[::-1, order]
    turned = three_paints.select([three_paints.names[paint] for paint in order])
    other = fit_paints(measured(turned, shares)).paints
    assert other.names == turned.names
    parts = np.random.default_rng(7).random((20, 3))
    expected = opaque_fit.paints.reflectance(parts)
    assert_allclose(other.reflectance(parts[:, order]), expected, atol=1e-3)
    theirs = opaque_fit.paints.errors.scattering
    assert_allclose(other.errors.scattering, theirs[order], rtol=0.05)


def test_one_mass_tone_leaves_the_scattering_to_the_rule(three_paints):
    """Yellow alone: its colour is fitted, and its S is that of the prior."""
    shares = plan(three_paints)[[0, 1, 2, 5, 6]]
    found = fit_paints(measured(three_paints, shares))
    white, yellow, red = np.median(found.paints.errors.scattering, axis=1)
    assert yellow > max(1.5 * white, 1.5 * red, 0.5)
    scattering = np.log(found.paints.pigments.scattering[1])
    assert_allclose(scattering, found.model.prior.log_scattering[1], atol=0.3)
    assert found.delta_e.max() < 0.2


def test_colours_alone_predict_mixtures(three_paints, opaque_fit):
    samples = opaque_fit.samples
    colours = MeasuredColours(samples.measured.rgb(three_paints.sensor))
    found = fit_paints(replace(samples, measured=colours))
    assert found.delta_e.max() < 1
    assert mixture_errors(found.paints, three_paints).mean() < 1.5


def test_paints_without_light_and_films_that_hide_are_fitted():
    """A black of reflectance 0, and a grey film whose ground does not matter."""
    ones = np.ones(16)
    samples = PaintSamples(
        ("black", "on white", "on black"),
        ("black", "grey"),
        np.array([[1.0, 0], [0, 1], [0, 1]]),
        np.array([np.inf, 1, 1]),
        np.outer([1, 1, 0], ones),
        WAVELENGTHS,
        MeasuredSpectra(np.outer([0, 0.5, 0.5], ones)),
    )
    found = fit_paints(samples, surface=Surface()).paints
    assert_allclose(found.reflectance(np.eye(2)), np.outer([0, 0.5], ones), atol=0.01)
    assert np.isfinite(found.pigments.absorption).all()
    assert (found.pigments.scattering > 0).all()
    assert found.surface == Surface()


def test_a_fit_that_stops_early_warns(opaque_fit, monkeypatch):
    monkeypatch.setattr(paint_fit, "MAX_STEPS", 2)
    with warns("paints-not-converged"):
        fit_paints(opaque_fit.samples)


def test_too_many_unknowns_raise(opaque_fit):
    samples = opaque_fit.samples
    paints = tuple(f"{paint}" for paint in range(200))
    shares = np.full((len(samples), 200), 1 / 200)
    with raises(OptionError, "too-many-paints"):
        fit_paints(replace(samples, paints=paints, shares=shares))


def test_samples_are_new_and_each_lowers_the_error(opaque_fit):
    advice = advise_samples(opaque_fit, 10)
    names = [sample.name for sample in advice.samples]
    assert sorted(names) == [
        "1 white : 1 red",
        "1 white : 1 yellow",
        "1 yellow : 1 red",
    ]
    errors = [advice.error, *(sample.error for sample in advice.samples)]
    assert (np.diff(errors) < 0).all()
    first = advise_samples(opaque_fit, 1)
    assert first.samples == advice.samples[:1]


def test_a_measured_sample_is_worth_what_was_predicted(three_paints, opaque_fit):
    """The fit with the sample expects the error that was predicted for it."""
    samples = opaque_fit.samples
    advice = advise_samples(opaque_fit, 1)
    name = advice.samples[0].name
    used = [f"1 {paint}" in name for paint in three_paints.names]
    shares = np.concatenate([samples.shares, [np.array(used) / 2]])
    more = fit_paints(measured(three_paints, shares))
    after = advise_samples(more, 5)
    assert after.error == pytest.approx(advice.samples[0].error, rel=0.1)
    assert name not in [sample.name for sample in after.samples]


def test_one_paint_has_an_expected_error():
    """That of the paint itself, as it has no mixtures."""
    white = invented(names=("white",))
    advice = advise_samples(fit_paints(measured(white, np.eye(1))))
    assert 0 < advice.error < 1
    assert advice.samples == ()
