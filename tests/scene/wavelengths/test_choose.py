"""So many wavelengths, or as few as a target allows: each promise checked on the ColorChecker."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.common.errors import OptionError, UnknownNameError
from uplift.scene.wavelengths import METHODS, RenderSetup, choose


@pytest.mark.parametrize("method", METHODS)
def test_gives_as_many_as_asked_and_states_what_a_renderer_would_get(
    smooth: RenderSetup, method: str
) -> None:
    choice = choose(smooth, count=5, method=method)
    sampling = choice.sampling
    assert len(sampling) == 5
    assert (np.diff(sampling.wavelengths) > 0).all()
    assert sampling.to_xyz[:, 1].sum() == pytest.approx(1)
    # The plain way: trace every light at every wavelength, sum with the weights.
    for light, name in enumerate(smooth.lights):
        for material in (0, 13):
            radiance = [
                sampling.powers[light, i] * float(smooth.curves(nm)[material])
                for i, nm in enumerate(sampling.wavelengths)
            ]
            apart = observer.colour_science().delta_E(
                smooth.lab[light, material],
                observer.colour_science().XYZ_to_Lab(
                    np.array(radiance) @ sampling.to_xyz,
                    observer.colour_science().XYZ_to_xy(smooth.whites[light]),
                ),
                method="CIE 2000",
            )
            assert choice.errors.delta_e[light, material] == pytest.approx(apart, abs=1e-6), name


def test_a_target_is_kept_and_one_wavelength_less_breaks_it(spiky: RenderSetup) -> None:
    choice = choose(spiky, target=1.5)
    assert choice.errors.max <= 1.5
    assert choose(spiky, count=len(choice.sampling) - 1).errors.max > 1.5


def test_a_mean_is_reached_earlier_than_a_maximum(spiky: RenderSetup) -> None:
    assert len(choose(spiky, target=1.5, measure="mean").sampling) < len(choose(spiky, target=1.5).sampling)


def test_is_the_same_every_time(smooth: RenderSetup) -> None:
    first, second = (choose(smooth, count=4).sampling for _ in range(2))
    np.testing.assert_array_equal(first.wavelengths, second.wavelengths)
    np.testing.assert_array_equal(first.to_xyz, second.to_xyz)


@pytest.mark.parametrize(
    "options",
    [{}, {"count": 4, "target": 1.0}, {"count": 0}, {"count": 41}, {"target": 0.0}, {"target": float("nan")}],
)
def test_refuses_options_out_of_range(smooth: RenderSetup, options: dict[str, float]) -> None:
    with pytest.raises(OptionError, match="; give"):
        choose(smooth, **options)


def test_says_when_a_target_is_out_of_reach(spiky: RenderSetup) -> None:
    with pytest.raises(OptionError, match="40 wavelengths by method 'uniform' leave"):
        choose(spiky, target=0.01, method="uniform")


def test_refuses_unknown_names(smooth: RenderSetup) -> None:
    with pytest.raises(UnknownNameError, match="did you mean 'uniform'"):
        choose(smooth, count=4, method="unform")
    with pytest.raises(UnknownNameError, match="'p95'"):
        choose(smooth, target=1, measure="p90")
