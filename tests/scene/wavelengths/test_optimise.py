"""Fitted wavelengths: metric, Jacobian and local fit against references; comparison with the other methods."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.scene.wavelengths import choose, fit_weights, make_setup
from uplift.scene.wavelengths.optimise import MAX_FITTED_PAIRS, FitProblem, delta_e_factors, fit_at, optimise
from uplift.scene.wavelengths.sampling import (
    RenderSetup,
    evaluate,
    midpoints,
    prefiltered,
    prefiltered_uniform,
    uniform,
)


def test_metric_is_delta_e_of_close_colours(spiky: RenderSetup) -> None:
    change = np.random.default_rng(4).normal(0, 1e-6, spiky.xyz.shape)
    approximate = np.linalg.norm(np.einsum("kmij,kmj->kmi", delta_e_factors(spiky), change), axis=-1)
    exact = delta_e_2000(spiky.lab, spiky.to_lab(spiky.xyz + change))
    np.testing.assert_allclose(approximate, exact, rtol=0.02)


def test_jacobian_agrees_with_central_differences(spiky: RenderSetup) -> None:
    small = FitProblem(spiky.only(range(0, 24, 5)))
    start = prefiltered_uniform(small.setup, 3)
    unknowns = small.pack(start)
    result = small.jacobian(unknowns)
    for column, step in enumerate(np.maximum(1e-6 * np.abs(unknowns), 1e-9)):
        up, down = (unknowns + sign * step * np.eye(len(unknowns))[column] for sign in (1, -1))
        slope = (small.residuals(up) - small.residuals(down)) / (2 * step)
        np.testing.assert_allclose(result[:, column], slope, rtol=1e-4, atol=1e-4 * np.abs(result).max())


@pytest.mark.parametrize("light", ["A", "FL11"])
def test_prefiltering_keeps_white_and_ramps_exact(checker: Array, light: str) -> None:
    """Both hold even if lines of the light lie between the wavelengths."""
    setup = make_setup(checker, [light])
    sampling = prefiltered(setup, midpoints(6))
    np.testing.assert_allclose(sampling.powers @ sampling.to_xyz, setup.whites, rtol=1e-12)
    nm = np.clip(setup.wavelengths, midpoints(6)[0], midpoints(6)[-1])
    ramp = setup.powers * (nm - 400) @ setup.cmfs
    np.testing.assert_allclose(sampling.powers * (midpoints(6) - 400) @ sampling.to_xyz, ramp, rtol=1e-12)


def test_uniform_wavelengths_are_point_sampled_and_balanced(spiky: RenderSetup) -> None:
    read = uniform(spiky, 6)
    ratio = read.powers / spiky.sampled_powers(midpoints(6))
    np.testing.assert_allclose(ratio, np.repeat(ratio[:, :1], 6, axis=1), rtol=1e-12)
    np.testing.assert_allclose((read.powers @ read.to_xyz)[:, 1], 1, rtol=1e-12)
    assert list(midpoints(3)) == [450, 550, 650]


@pytest.mark.parametrize("count", [1, 4, 9])
def test_fit_is_not_negative_and_powers_are_proportional_to_the_lights(spiky: RenderSetup, count: int) -> None:
    result = optimise(spiky, count)
    assert len(result) == count
    assert result.to_xyz.min() >= 0
    assert result.powers.min() >= 0
    assert (np.diff(result.wavelengths) > 0).all()
    nearby = prefiltered(spiky, result.wavelengths).powers.sum(axis=0)
    ratio = result.powers.sum(axis=0) / nearby
    assert np.ptp(ratio) < 1e-9 * ratio.max()


@pytest.mark.parametrize("count", [4, 8])
def test_fit_beats_other_methods_on_unseen_materials(smooth: RenderSetup, spiky: RenderSetup, count: int) -> None:
    odd = np.arange(24) % 2 == 1
    for setup, factor in ((smooth, 1.5), (spiky, 3.0)):
        unseen = setup.only(odd)
        error = evaluate(unseen, optimise(setup.only(~odd), count)).mean
        for method in ("meyer", "uniform", "bins"):
            assert factor * error < choose(unseen, count=count, method=method).errors.mean, method


def test_one_material_and_more_materials_than_are_fitted(checker: Array) -> None:
    one = choose(make_setup(checker[:1], ["FL11"]), count=4)
    assert one.errors.max < 0.2
    shades = np.concatenate([checker * shade for shade in np.linspace(0.05, 1, MAX_FITTED_PAIRS // 24 + 2)])
    many = choose(make_setup(shades, ["D65"]), count=4)
    assert many.errors.delta_e.shape == (1, len(shades))
    assert len(shades) > MAX_FITTED_PAIRS
    assert many.errors.mean < 2


def test_weights_for_given_wavelengths_beat_prefiltering(spiky: RenderSetup) -> None:
    nm = midpoints(7)
    result = fit_at(spiky, nm[::-1])
    np.testing.assert_array_equal(result.wavelengths, nm)
    assert min(result.to_xyz.min(), result.powers.min()) >= 0
    error = evaluate(spiky, result).mean
    assert evaluate(spiky, optimise(spiky, 7)).mean < error < evaluate(spiky, prefiltered_uniform(spiky, 7)).mean / 1.5


@pytest.mark.parametrize("nm", [[], [500, 500], [300, 500], [500, 800], [[500]], [np.nan]])
def test_invalid_wavelengths_raise(smooth: RenderSetup, nm: list[float]) -> None:
    with raises(OptionError, "invalid-wavelengths"):
        fit_weights(smooth, nm)
