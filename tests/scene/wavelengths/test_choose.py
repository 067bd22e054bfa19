"""A given number of wavelengths, or the fewest that meet a target, on the ColorChecker."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import OptionError, UnknownNameError
from uplift.scene.wavelengths import METHODS, choose
from uplift.scene.wavelengths.sampling import RenderSetup


@pytest.mark.parametrize("method", METHODS)
def test_errors_are_those_of_a_renderer_with_count_wavelengths(smooth: RenderSetup, method: str) -> None:
    choice = choose(smooth, count=5, method=method)
    sampling = choice.sampling
    assert len(sampling) == 5
    assert (np.diff(sampling.wavelengths) > 0).all()
    assert sampling.to_xyz[:, 1].sum() == pytest.approx(1)
    # Reference: trace every light at every wavelength, sum with the weights.
    for light, name in enumerate(smooth.lights):
        for material in (0, 13):
            radiance = [
                sampling.powers[light, i] * float(smooth.curves(nm)[material])
                for i, nm in enumerate(sampling.wavelengths)
            ]
            delta_e = observer.colour_science().delta_E(
                smooth.lab[light, material],
                observer.colour_science().XYZ_to_Lab(
                    np.array(radiance) @ sampling.to_xyz, observer.colour_science().XYZ_to_xy(smooth.whites[light])
                ),
                method="CIE 2000",
            )
            assert choice.errors.delta_e[light, material] == pytest.approx(delta_e, abs=1e-6), name


def test_target_is_met_and_one_wavelength_less_misses_it(spiky: RenderSetup) -> None:
    choice = choose(spiky, target=1.5)
    assert choice.errors.max <= 1.5
    assert choose(spiky, count=len(choice.sampling) - 1).errors.max > 1.5


def test_target_skips_counts_without_a_rule(smooth: RenderSetup) -> None:
    """Meyer's rules have at least four wavelengths."""
    choice = choose(smooth, target=100, method="meyer")
    assert len(choice.sampling) == 4


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({}, "option"),
        ({"count": 4, "target": 1.0}, "option"),
        ({"count": 0}, "option"),
        ({"count": 41}, "option"),
        ({"target": 0.0}, "target-not-positive"),
        ({"target": float("nan")}, "target-not-positive"),
    ],
)
def test_invalid_options_raise(smooth: RenderSetup, options: dict[str, float], code: str) -> None:
    with raises(OptionError, code):
        choose(smooth, **options)


def test_unknown_names_raise_with_the_nearest_name(smooth: RenderSetup) -> None:
    with raises(UnknownNameError, "unknown-method") as caught:
        choose(smooth, count=4, method="unform")
    assert "'uniform'" in caught.value.hint
    with raises(UnknownNameError, "unknown-measure") as caught:
        choose(smooth, target=1, measure="p90")
    assert "'p95'" in caught.value.hint
