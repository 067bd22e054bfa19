"""Samples of pixels, colour errors against a slow oracle, and the choice among candidates."""

import numpy as np
import pytest

from tests.io.texture.conftest import planes, write_exr
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.scene.plan.context import sample_colours
from uplift.scene.plan.evaluation import (
    WORST_DELTA_E,
    ColourGroup,
    ErrorSummary,
    EvaluationSet,
    GroupError,
    Trial,
    decide,
)

LIGHTS = ("D65", "FL11")


@pytest.fixture(scope="module")
def tests():
    rng = np.random.default_rng(0)
    weights = rng.random(40)
    groups = (
        ColourGroup("textures", rng.random((40, 3)), rng.random((40, 81)), weights / weights.sum()),
        ColourGroup("materials", rng.random((7, 3)), rng.random((7, 81)), np.full(7, 1 / 7)),
    )
    return EvaluationSet(groups, tuple(observer.light(name) for name in LIGHTS), 0.8)


def weighted_quantile(values, weights, share):
    """Smallest value that bounds this share of the weights."""
    total = 0.0
    for value, weight in sorted(zip(values, weights, strict=True)):
        total += weight
        if total >= share - 1e-12:
            return value
    raise AssertionError


def test_errors_agree_with_a_slow_oracle(tests):
    spectra = np.clip(tests.reflectances + np.random.default_rng(1).normal(0, 0.02, (47, 81)), 0, 1)
    error = tests.error(spectra)
    rows = {"textures": slice(0, 40), "materials": slice(40, 47)}
    assert len(error.parts) == 4
    for part in error.parts:
        group = next(each for each in tests.groups if each.name == part.group)
        delta_e = delta_e_spectra(observer.light(part.light), group.reflectances, spectra[rows[part.group]])
        assert part.quantile == pytest.approx(weighted_quantile(delta_e, group.weights, 0.8), rel=1e-9)
        assert part.mean == pytest.approx(np.average(delta_e, weights=group.weights), rel=1e-9)
        assert part.largest == pytest.approx(delta_e.max(), rel=1e-9)
    assert error.quantile == max(part.quantile for part in error.parts)


def test_reference_spectra_have_no_error_and_nan_has_the_largest(tests):
    assert tests.error(tests.reflectances).quantile == pytest.approx(0, abs=1e-9)
    broken = tests.reflectances.copy()
    broken[3] = np.nan
    error = tests.error(broken)
    assert {part.largest for part in error.parts if part.group == "textures"} == {WORST_DELTA_E}


@pytest.mark.parametrize(
    ("errors", "selected", "measured"), [((3.0, 0.9, 0.1), 1, 2), ((5, 2, 3), 1, 3)], ids=["sufficient", "none"]
)
def test_the_first_sufficient_candidate_or_else_the_best_is_selected(errors, selected, measured):
    parts = [(GroupError("textures", "D65", 0.0, error, error),) for error in errors]
    trials = iter([Trial(str(number), 1.0, "", "", {}, ErrorSummary(part)) for number, part in enumerate(parts)])
    decision = decide("a", "A", "things", 1.0, trials)
    assert (decision.selected, len(decision.trials), len(list(trials))) == (selected, measured, len(errors) - measured)
    assert decision.within_limit == (errors[selected] <= 1)


@pytest.fixture
def image(tmp_path):
    """A file of linear RGB (h, w, 3)."""
    return lambda rgb, name="a.exr": write_exr(tmp_path / name, planes(np.asarray(rgb, np.float32)))


def test_small_textures_are_sampled_completely(image, sensor):
    rgb = np.array([[[0.1, 0.2, 0.3], [0.1, 0.2, 0.3], [0.5, 0.5, 0.5], [0.1, 0.2, 0.3]]])
    found = sample_colours((image(rgb), image(rgb, "b.exr")), sensor, "auto", (4, 6))
    for sample in (found.predicting, found.confirming):
        np.testing.assert_allclose(sample.rgb, [[0.1, 0.2, 0.3], [0.5, 0.5, 0.5]], rtol=1e-6)
        np.testing.assert_allclose(sample.share, [0.75, 0.25])
    assert len(found.colour_bins) == 2


def test_the_two_samples_of_a_large_texture_are_disjoint(image, sensor):
    rgb = np.random.default_rng(1).random((100, 90, 3))
    path = image(rgb)
    found = sample_colours((path,), sensor, "auto", (300, 600))
    first, second = (set(map(tuple, sample.rgb.tolist())) for sample in (found.predicting, found.confirming))
    assert not first & second
    assert 240 < len(first) < 360
    assert 500 < len(second) < 700
    assert first | second <= set(map(tuple, rgb.astype(np.float32).reshape(-1, 3).astype(float).tolist()))
    for sample in (found.predicting, found.confirming):
        assert sample.share.sum() == pytest.approx(1)
        np.testing.assert_allclose(sample.share @ sample.rgb, 0.5, atol=0.06)  # equal probability
    again = sample_colours((path,), sensor, "auto", (300, 600))
    np.testing.assert_array_equal(again.predicting.rgb, found.predicting.rgb)


def test_rare_colours_have_a_bin(image, sensor):
    rgb = np.full((80, 80, 3), 0.25)
    rgb[40, 40] = [0.9, 0.05, 0.1]
    found = sample_colours((image(rgb),), sensor, "auto", (50, 50))
    np.testing.assert_allclose(np.sort(found.colour_bins[:, 0]), [0.25, 0.9], rtol=1e-6)
