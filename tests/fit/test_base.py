"""Base spectra: nearly the colour, dark where the colour is dark, and learnt ones
better for unknown materials.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.sensor import in_unit_cube
from uplift.extras.report.comparison import delta_e_under
from uplift.fit.base import learn_base, match_spectra
from uplift.fit.entries import FittedEntries
from uplift.fit.families import Family, shipped_library
from uplift.fit.problem import Problem
from uplift.models.model import evaluate
from uplift.models.moments import Moments, moment_matrix

LIGHTS = tuple(map(observer.light, SCENE_LIGHTS))
GRID = observer.grid()
DARK = np.array(
    [
        (0.05, 0.001, 0.001),
        (0.02, 0.002, 0.002),
        (0.1, 0, 0),
        (0.02, 0, 0.02),
        (0, 0.05, 0),
    ]
)


def entries_of(sensor, measured):
    """Entries in gamut; only their colours and measurements matter to the base."""
    rgb = sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    rgb = np.clip(rgb[inside], 0, 1)
    measured = measured[inside]
    return FittedEntries(rgb, measured, np.zeros((len(rgb), 9)), np.zeros(len(rgb)))


def answers(problem, sensor, base, rgb):
    start = problem.model.from_storage(base.coefficients(rgb))
    return evaluate(
        problem.model, problem.solve(rgb, start, 24).multipliers, sensor.wavelengths
    )


@pytest.mark.parametrize("name", ["tcs", "rawtoaces"])
def test_unseen_families_are_predicted_better_than_by_smooth_spectra(
    problem, sensor, name
):
    (unseen,) = [family for family in shipped_library() if family.name == name]
    known = entries_of(sensor, unseen.measured)
    learnt = learn_base(problem, shipped_library([name]))[0]
    spectra, smooth = (
        answers(problem, sensor, base, known.rgb)
        for base in (learnt, learn_base(problem)[0])
    )
    for light in LIGHTS[1:]:
        error = delta_e_spectra(light, spectra, known.measured).mean()
        smooth_error = delta_e_spectra(light, smooth, known.measured).mean()
        assert error < 0.97 * smooth_error, light.name


@pytest.mark.parametrize(
    ("model", "space", "illuminant"),
    [
        (Moments(17, 380.0, 780.0, "vision"), "sRGB", "FL11"),
        (Moments(9), "ProPhoto RGB", "A"),
    ],
    ids=str,
)
def test_spectra_are_valid_and_continuous_in_every_space(model, space, illuminant):
    problem = Problem(observer.sensor(space, illuminant), model, LIGHTS)
    base = learn_base(problem, shipped_library())[0]
    rgb = np.random.default_rng(1).random((3000, 3)) ** 2
    coefficients = base.coefficients(rgb)
    assert np.isfinite(model.from_storage(coefficients)).all()
    moved = base.coefficients(np.clip(rgb + 1e-6, 0, 1))
    assert np.abs(moved - coefficients).max() < 1e-3


def test_dark_saturated_colours_stay_dark_outside_the_visible_range(problem, sensor):
    for families in ((), shipped_library()):
        spectra = answers(problem, sensor, learn_base(problem, families)[0], DARK)
        assert spectra[:, 76].max() < 0.4
    from_grey = problem.solve(DARK, np.zeros((len(DARK), 9)), 192).multipliers
    assert evaluate(problem.model, from_grey, sensor.wavelengths)[:, 76].max() > 0.9


def test_an_atlas_raises_the_relevance_of_families_like_it(problem, sensor):
    """The atlas deviates from smooth spectra exactly as one family, the others are
    noise.
    """
    rng = np.random.default_rng(4)
    (like,) = [family for family in shipped_library() if family.name == "rawtoaces"]
    own, rest = np.array_split(rng.permutation(len(like.measured)), 2)
    noise = Family(
        "noise", rng.permutation(like.measured[rest], axis=0)[:, ::-1], 1.0, 0.5
    )
    family = Family("family", like.measured[rest], 1.0, 0.5)
    entries = entries_of(sensor, like.measured[own])
    related, unrelated = learn_base(problem, [family, noise], entries)[1]
    assert related > unrelated + 0.2


def test_spectra_of_the_atlas_are_no_evidence_for_themselves(problem, sensor):
    """A library that is the atlas has no spectra left: the base is that of smooth
    spectra.
    """
    (same,) = [family for family in shipped_library() if family.name == "tcs"]
    learnt, relevance = learn_base(problem, [same], entries_of(sensor, same.measured))
    assert relevance == (1.0,)
    rgb = np.random.default_rng(0).uniform(0.05, 0.9, (50, 3))
    found, smooth = (
        answers(problem, sensor, base, rgb) for base in (learnt, learn_base(problem)[0])
    )
    assert_allclose(found, smooth, atol=0.06)


@pytest.mark.parametrize(
    "model", [Moments(9), Moments(17), Moments(9, 380.0, 780.0, "vision")], ids=str
)
def test_measured_spectra_have_moments_that_keep_their_colours(model):
    library = np.clip(shipped_library()[0].measured, 1e-3, 1 - 1e-3)
    moments = library @ moment_matrix(model, GRID)
    plain = evaluate(model, model.from_storage(moments), GRID)
    assert_allclose(plain @ moment_matrix(model, GRID), moments, atol=3e-4)
    matched = evaluate(model, match_spectra(model, GRID, library, LIGHTS), GRID)
    plain_error = delta_e_under(LIGHTS, plain, library).max(axis=1)
    matched_error = delta_e_under(LIGHTS, matched, library).max(axis=1)
    assert matched_error.mean() < 0.7 * plain_error.mean()
