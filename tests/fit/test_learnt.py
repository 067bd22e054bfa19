"""The learnt base: better than smooth spectra for materials it does not know, valid in every space and model."""

from __future__ import annotations

import numpy as np
import pytest

from tests.fit.test_smooth import DARK
from uplift import fit
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.library import shipped_library
from uplift.fit.prior import smooth_base
from uplift.lattice import Lattice
from uplift.models import Moments, Phase, Sigmoid, evaluate
from uplift.models.minimum_norm import forward_map

LIGHTS = [observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3")]
UNSEEN = ("tcs", "vs", "rawtoaces")


def problem_of(model, sensor):
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    return fit.Problem(model, forward, Lattice(np.array([0.0, 1.0])))


@pytest.fixture(scope="module")
def problem(sensor):
    return problem_of(Moments(9), sensor)


def entries_of(sensor, measured):
    """Entries in gamut; only their colours and measurements matter to the base."""
    rgb = sensor.rgb(measured)
    inside = sensor.contains(rgb)
    rgb, measured = np.clip(rgb[inside], 0, 1), measured[inside]
    return fit.FittedEntries(rgb, measured, np.zeros((len(rgb), 9)), np.zeros(len(rgb)))


NOBODY = fit.FittedEntries(np.zeros((0, 3)), np.zeros((0, 81)), np.zeros((0, 9)), np.zeros(0))


def answers(problem, sensor, base, rgb):
    start = problem.model.from_storage(base.coefficients(rgb))
    return evaluate(problem.model, problem.solve(rgb, start, 24).multipliers, sensor.wavelengths)


@pytest.mark.parametrize("name", UNSEEN)
def test_unseen_families_are_predicted_better_than_by_smooth_spectra(problem, sensor, name):
    (unseen,) = [family for family in shipped_library() if family.name == name]
    known = entries_of(sensor, unseen.measured)
    learnt = fit.learn_base(problem, sensor, LIGHTS, shipped_library([name]), NOBODY).base
    for light in LIGHTS[1:]:
        error, smooth_error = (
            delta_e_spectra(light, answers(problem, sensor, base, known.rgb), known.measured).mean()
            for base in (learnt, smooth_base(problem, sensor))
        )
        assert error < 0.97 * smooth_error, light.name


@pytest.mark.parametrize(
    ("model", "space", "illuminant"),
    [
        (Moments(4), "sRGB", "D65"),
        (Moments(17, Phase(380.0, 780.0, "vision")), "sRGB", "FL11"),
        (Moments(9), "ProPhoto RGB", "A"),
    ],
    ids=lambda value: getattr(value, "count", value),
)
def test_spectra_are_valid_and_continuous_in_every_space(model, space, illuminant):
    sensor = observer.sensor(space, illuminant)
    problem = problem_of(model, sensor)
    base = fit.learn_base(problem, sensor, LIGHTS, shipped_library(), NOBODY).base
    rgb = np.random.default_rng(1).random((3000, 3)) ** 2
    coefficients = base.coefficients(rgb)
    assert np.isfinite(model.from_storage(coefficients)).all()
    moved = base.coefficients(np.clip(rgb + 1e-6, 0, 1))
    assert np.abs(moved - coefficients).max() < 1e-3


def test_a_dark_saturated_colour_stays_dark_outside_the_visible_range(problem, sensor):
    base = fit.learn_base(problem, sensor, LIGHTS, shipped_library(), NOBODY).base
    assert answers(problem, sensor, base, DARK)[:, 76].max() < 0.4


def test_the_spectrum_is_nearly_of_the_colour(problem, sensor):
    base = fit.learn_base(problem, sensor, LIGHTS, shipped_library(), NOBODY).base
    rgb = np.random.default_rng(3).random((500, 3)) ** 2
    spectra = evaluate(problem.model, problem.model.from_storage(base.coefficients(rgb)), sensor.wavelengths)
    off = np.abs(sensor.rgb(spectra) - rgb).max(axis=1)
    assert off.max() < 0.03
    assert np.median(off) < 0.002


def test_an_atlas_raises_the_relevance_of_families_like_it(problem, sensor):
    """The atlas deviates from smooth spectra exactly as one family, the others are noise."""
    rng = np.random.default_rng(4)
    (like,) = [family for family in shipped_library() if family.name == "rawtoaces"]
    own, rest = np.array_split(rng.permutation(len(like.measured)), 2)
    noise = fit.Family("noise", rng.permutation(like.measured[rest], axis=0)[:, ::-1], 1.0, 0.5)
    family = fit.Family("family", like.measured[rest], 1.0, 0.5)
    entries = entries_of(sensor, like.measured[own])
    related, unrelated = fit.learn_base(problem, sensor, LIGHTS, [family, noise], entries).relevance
    assert related > unrelated + 0.2
    again = entries_of(sensor, like.measured[own[::-1]])
    assert fit.learn_base(problem, sensor, LIGHTS, [family, noise], again).relevance == pytest.approx(
        (related, unrelated), abs=1e-9
    )


def test_spectra_of_the_atlas_are_no_evidence_for_themselves(problem, sensor):
    """A library that is the atlas has no spectra left: the base is that of smooth spectra."""
    (same,) = [family for family in shipped_library() if family.name == "tcs"]
    learnt = fit.learn_base(problem, sensor, LIGHTS, [same], entries_of(sensor, same.measured))
    assert learnt.relevance == (1.0,)
    smooth = smooth_base(problem, sensor)
    rgb = np.random.default_rng(0).uniform(0.05, 0.9, (50, 3))
    np.testing.assert_allclose(
        answers(problem, sensor, learnt.base, rgb), answers(problem, sensor, smooth, rgb), atol=0.06
    )


@pytest.mark.parametrize("model", [Moments(3), Sigmoid()], ids=lambda model: model.name)
def test_models_of_three_coefficients_have_no_freedom(model, sensor):
    problem = problem_of(model, sensor)
    learnt = fit.learn_base(problem, sensor, LIGHTS, shipped_library(), NOBODY)
    assert not fit.has_freedom(model)
    rgb = np.random.default_rng(0).random((5, 3))
    np.testing.assert_array_equal(learnt.base.coefficients(rgb), smooth_base(problem, sensor).coefficients(rgb))
    assert fit.has_freedom(Moments(4))
