"""Base spectra: nearly the colour, dark where the colour is dark, and learnt ones
better for unknown materials.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.fit.base import learn_base, match_spectra
from uplift.fit.entries import FittedEntries
from uplift.fit.families import Family, shipped_library
from uplift.fit.problem import Problem
from uplift.models.model import evaluate, reflectance
from uplift.models.moments import Moments, moment_matrix

LIGHTS = tuple(observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3"))
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


@pytest.fixture(scope="module")
def problem(sensor):
    return Problem(sensor, Moments(9), LIGHTS)


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


@pytest.mark.parametrize("name", ["tcs", "vs", "rawtoaces"])
def test_unseen_families_are_predicted_better_than_by_smooth_spectra(
    problem, sensor, name
):
    (unseen,) = [family for family in shipped_library() if family.name == name]
    known = entries_of(sensor, unseen.measured)
    learnt = learn_base(problem, shipped_library([name]))[0]
    for light in LIGHTS[1:]:
        error, smooth_error = (
            delta_e_spectra(
                light, answers(problem, sensor, base, known.rgb), known.measured
            ).mean()
            for base in (learnt, learn_base(problem)[0])
        )
        assert error < 0.97 * smooth_error, light.name


@pytest.mark.parametrize(
    ("model", "space", "illuminant"),
    [
        (Moments(4), "sRGB", "D65"),
        (Moments(17, 380.0, 780.0, "vision"), "sRGB", "FL11"),
        (Moments(9), "ProPhoto RGB", "A"),
    ],
    ids=lambda value: getattr(value, "count", value),
)
def test_spectra_are_valid_and_continuous_in_every_space(model, space, illuminant):
    sensor = observer.sensor(space, illuminant)
    problem = Problem(sensor, model, LIGHTS)
    base = learn_base(problem, shipped_library())[0]
    rgb = np.random.default_rng(1).random((3000, 3)) ** 2
    coefficients = base.coefficients(rgb)
    assert np.isfinite(model.from_storage(coefficients)).all()
    moved = base.coefficients(np.clip(rgb + 1e-6, 0, 1))
    assert np.abs(moved - coefficients).max() < 1e-3


@pytest.mark.parametrize(
    ("families", "worst", "median"), [((), 0.02, 0.001), (None, 0.03, 0.002)]
)
def test_base_spectra_have_nearly_the_colour(problem, sensor, families, worst, median):
    base = learn_base(problem, shipped_library() if families is None else families)[0]
    rgb = np.random.default_rng(3).random((500, 3)) ** 2
    off = np.abs(
        sensor.rgb(
            reflectance(problem.model, base.coefficients(rgb), sensor.wavelengths)
        )
        - rgb
    ).max(axis=1)
    assert off.max() < worst
    assert np.median(off) < median


def test_dark_saturated_colours_stay_dark_outside_the_visible_range(problem, sensor):
    for families in ((), shipped_library()):
        assert (
            answers(problem, sensor, learn_base(problem, families)[0], DARK)[
                :, 76
            ].max()
            < 0.4
        )
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
    again = entries_of(sensor, like.measured[own[::-1]])
    assert learn_base(problem, [family, noise], again)[1] == pytest.approx(
        (related, unrelated), abs=1e-9
    )


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


MODELS = [Moments(9), Moments(17), Moments(9, 380.0, 780.0, "vision")]


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_moments_of_sampled_spectra_are_those_of_the_model(model):
    multipliers = (
        np.random.default_rng(2).normal(size=(20, model.count))
        / (1 + np.arange(model.count)) ** 2
    )
    spectra = evaluate(model, multipliers, GRID)
    assert_allclose(
        spectra @ moment_matrix(model, GRID), model.to_storage(multipliers), atol=3e-4
    )


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_colours_of_measured_spectra_survive(model):
    measured = np.clip(shipped_library()[0].measured, 1e-3, 1 - 1e-3)
    plain = model.from_storage(measured @ moment_matrix(model, GRID))
    matched = match_spectra(model, GRID, measured, LIGHTS)

    def worst(multipliers):
        spectra = evaluate(model, multipliers, GRID)
        return np.max(
            [delta_e_spectra(light, spectra, measured) for light in LIGHTS], axis=0
        ).mean()

    assert worst(matched) < 0.7 * worst(plain)
