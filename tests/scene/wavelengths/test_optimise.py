"""The project's own choice: its parts against plain ones, and what it promises."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.delta_e import delta_e_2000
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.scene.wavelengths import RenderSetup, choose, evaluate, fit_weights, make_setup
from uplift.scene.wavelengths.local_fit import polish, problem
from uplift.scene.wavelengths.metric import delta_e_factors
from uplift.scene.wavelengths.optimise import MAX_FITTED_PAIRS, fit_at, optimise
from uplift.scene.wavelengths.uniform import midpoints, prefiltered, prefiltered_uniform, uniform


def test_the_metric_is_delta_e_of_colours_close_together(spiky: RenderSetup) -> None:
    apart = np.random.default_rng(4).normal(0, 1e-6, spiky.xyz.shape)
    near = np.linalg.norm(np.einsum("kmij,kmj->kmi", delta_e_factors(spiky), apart), axis=-1)
    exact = delta_e_2000(spiky.lab, spiky.to_lab(spiky.xyz + apart))
    np.testing.assert_allclose(near, exact, rtol=0.02)


def test_the_metric_is_finite_for_black_and_grey() -> None:
    flat = make_setup(np.outer([0, 0.18, 1], np.ones(391)), ["A"])
    assert np.isfinite(delta_e_factors(flat)).all()


def test_the_jacobian_is_that_of_the_residuals(spiky: RenderSetup) -> None:
    small = problem(spiky.only(range(0, 24, 5)))
    start = prefiltered_uniform(small.setting, 3)
    unknowns = np.concatenate([start.wavelengths, start.to_xyz.ravel(), start.powers.ravel()])
    found = small.jacobian(unknowns)
    for column, step in enumerate(np.maximum(1e-6 * np.abs(unknowns), 1e-9)):
        up, down = (unknowns + sign * step * np.eye(len(unknowns))[column] for sign in (1, -1))
        slope = (small.residuals(up) - small.residuals(down)) / (2 * step)
        np.testing.assert_allclose(found[:, column], slope, rtol=1e-4, atol=1e-4 * np.abs(found).max())


def test_unknowns_come_back_as_they_went_in(spiky: RenderSetup) -> None:
    start = prefiltered_uniform(spiky, 5)
    back = problem(spiky).unpack(
        np.concatenate([start.wavelengths, start.to_xyz.ravel(), start.powers.ravel()])
    )
    for name in ("wavelengths", "to_xyz", "powers"):
        np.testing.assert_array_equal(getattr(back, name), getattr(start, name))


def test_polishing_only_betters(spiky: RenderSetup) -> None:
    least = problem(spiky)
    start = prefiltered_uniform(spiky, 6)
    assert evaluate(spiky, polish(least, start)).mean < evaluate(spiky, start).mean / 2


@pytest.mark.parametrize("light", ["A", "FL11"])
def test_prefiltered_lights_are_whole(checker: Array, light: str) -> None:
    """White is exact, whatever the lines do between the wavelengths, and so is a ramp under the hats."""
    seen = make_setup(checker, [light])
    caught = prefiltered(seen, midpoints(6))
    np.testing.assert_allclose(caught.powers @ caught.to_xyz, seen.whites, rtol=1e-12)
    nm = np.clip(seen.wavelengths, midpoints(6)[0], midpoints(6)[-1])
    ramp = seen.powers * (nm - 400) @ seen.cmfs
    np.testing.assert_allclose(caught.powers * (midpoints(6) - 400) @ caught.to_xyz, ramp, rtol=1e-12)


def test_even_wavelengths_are_read_off_and_balanced(spiky: RenderSetup) -> None:
    read = uniform(spiky, 6)
    ratio = read.powers / spiky.sampled_powers(midpoints(6))
    np.testing.assert_allclose(ratio, np.repeat(ratio[:, :1], 6, axis=1), rtol=1e-12)
    np.testing.assert_allclose((read.powers @ read.to_xyz)[:, 1], 1, rtol=1e-12)
    assert list(midpoints(3)) == [450, 550, 650]


@pytest.mark.parametrize("count", [1, 4, 9])
def test_nothing_is_negative_and_powers_look_like_the_lights(spiky: RenderSetup, count: int) -> None:
    found = optimise(spiky, count)
    assert len(found) == count
    assert found.to_xyz.min() >= 0
    assert found.powers.min() >= 0
    assert (np.diff(found.wavelengths) > 0).all()
    nearby = prefiltered(spiky, found.wavelengths).powers.sum(axis=0)
    ratio = found.powers.sum(axis=0) / nearby
    assert np.ptp(ratio) < 1e-9 * ratio.max()


@pytest.mark.parametrize("count", [4, 8])
def test_beats_the_others_on_materials_that_it_has_not_seen(
    smooth: RenderSetup, spiky: RenderSetup, count: int
) -> None:
    odd = np.arange(24) % 2 == 1
    for seen, factor in ((smooth, 1.5), (spiky, 3.0)):
        unseen = seen.only(odd)
        ours = evaluate(unseen, optimise(seen.only(~odd), count)).mean
        for method in ("meyer", "uniform", "bins"):
            assert factor * ours < choose(unseen, count=count, method=method).errors.mean, method


def test_white_stays_white(spiky: RenderSetup) -> None:
    found = optimise(spiky, 8)
    white = make_setup(np.ones((1, 391)), spiky.lights)
    assert evaluate(white, found).max < 0.3


def test_a_single_material_and_more_than_are_fitted(checker: Array) -> None:
    one = choose(make_setup(checker[:1], ["FL11"]), count=4)
    assert one.errors.max < 0.2
    shades = np.concatenate([checker * shade for shade in np.linspace(0.05, 1, MAX_FITTED_PAIRS // 24 + 2)])
    many = choose(make_setup(shades, ["D65"]), count=4)
    assert many.errors.delta_e.shape == (1, len(shades))
    assert len(shades) > MAX_FITTED_PAIRS
    assert many.errors.mean < 2


def test_given_wavelengths_are_kept_and_their_weights_better_than_plain_ones(spiky: RenderSetup) -> None:
    nm = midpoints(7)
    found = fit_at(spiky, nm[::-1])
    np.testing.assert_array_equal(found.wavelengths, nm)
    assert min(found.to_xyz.min(), found.powers.min()) >= 0
    ours = evaluate(spiky, found).mean
    assert (
        evaluate(spiky, optimise(spiky, 7)).mean
        < ours
        < evaluate(spiky, prefiltered_uniform(spiky, 7)).mean / 1.5
    )


@pytest.mark.parametrize("nm", [[], [500, 500], [300, 500], [500, 800], [[500]], [np.nan]])
def test_refuses_wavelengths_that_are_none(smooth: RenderSetup, nm: list[float]) -> None:
    with pytest.raises(OptionError, match="; give each once, from 380 to 770 nm"):
        fit_weights(smooth, nm)
