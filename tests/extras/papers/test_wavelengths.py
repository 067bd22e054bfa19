"""Wavelengths on the ColorChecker: setups, the methods against references and each
other, and invalid input.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import UpliftError
from uplift.extras.papers.wavelengths import (
    METHODS,
    choose,
    fit_weights,
    grid,
    make_setup,
)
from uplift.extras.papers.wavelengths.optimise import FitProblem, optimise
from uplift.extras.papers.wavelengths.sampling import evaluate, midpoints, prefiltered


@pytest.mark.parametrize("method", METHODS)
def test_errors_are_those_of_a_renderer_with_count_wavelengths(smooth, method):
    choice = choose(smooth, count=5, method=method)
    sampling = choice.sampling
    assert len(sampling) == 5
    assert (np.diff(sampling.wavelengths) > 0).all()
    assert sampling.to_xyz[:, 1].sum() == pytest.approx(1)
    # Reference: trace every light at every wavelength, sum with the weights.
    traced = np.stack([smooth.curves(nm) for nm in sampling.wavelengths], axis=-1)
    for light, white in enumerate(smooth.whites):
        xyz = (sampling.powers[light] * traced) @ sampling.to_xyz
        expected = delta_e_2000(smooth.lab[light], lab(xyz, white))
        assert_allclose(choice.errors[light], expected, atol=1e-6)


def test_target_is_met_and_one_wavelength_less_misses_it(spiky):
    choice = choose(spiky, target=1.5)
    assert choice.errors.max() <= 1.5
    assert choose(spiky, count=len(choice.sampling) - 1).errors.max() > 1.5


def test_jacobian_agrees_with_central_differences(spiky):
    small = FitProblem(spiky.only(range(0, 24, 5)))
    unknowns = small.pack(prefiltered(small.setup, midpoints(3)))
    steps = np.diag(np.maximum(1e-6 * np.abs(unknowns), 1e-9))
    slopes = []
    for step in steps:
        rise = small.residuals(unknowns + step) - small.residuals(unknowns - step)
        slopes.append(rise / (2 * step.max()))
    result = small.jacobian(unknowns)
    scale = 1e-4 * np.abs(result).max()
    assert_allclose(result, np.stack(slopes, axis=1), rtol=1e-4, atol=scale)


@pytest.mark.parametrize("light", ["A", "FL11"])
def test_prefiltering_keeps_white_and_ramps_exact(checker, light):
    """Both hold even if lines of the light lie between the wavelengths."""
    setup = make_setup(checker, [light])
    nodes = midpoints(6)
    sampling = prefiltered(setup, nodes)
    assert_allclose(sampling.powers @ sampling.to_xyz, setup.whites, rtol=1e-12)
    nm = np.clip(setup.wavelengths, nodes[0], nodes[-1])
    ramp = setup.powers * (nm - 400) @ setup.cmfs
    found = sampling.powers * (nodes - 400) @ sampling.to_xyz
    assert_allclose(found, ramp, rtol=1e-12)


@pytest.mark.parametrize("count", [1, 4, 9])
def test_fit_is_not_negative_and_powers_are_proportional_to_the_lights(spiky, count):
    result = optimise(spiky, count)
    assert len(result) == count
    assert result.to_xyz.min() >= 0
    assert result.powers.min() >= 0
    assert (np.diff(result.wavelengths) > 0).all()
    nearby = prefiltered(spiky, result.wavelengths).powers.sum(axis=0)
    ratio = result.powers.sum(axis=0) / nearby
    assert np.ptp(ratio) < 1e-9 * ratio.max()


def test_fit_beats_other_methods_on_unseen_materials(smooth, spiky):
    odd = np.arange(24) % 2 == 1
    for setup, factor in ((smooth, 1.5), (spiky, 3.0)):
        unseen = setup.only(odd)
        error = evaluate(unseen, optimise(setup.only(~odd), 8)).mean()
        for method in ("meyer", "uniform", "bins"):
            other = choose(unseen, count=8, method=method).errors.mean()
            assert factor * error < other, method


ONES = np.ones((1, 391))
INVALID = [
    (make_setup, ONES[0], {"lights": ["A"]}),
    (make_setup, np.nan * ONES, {"lights": ["A"]}),
    (make_setup, ONES, {"lights": ["A"], "wavelengths": grid()[::-1]}),
    (make_setup, ONES[:, :3], {"lights": ["A"], "wavelengths": [400, 500, 600]}),
    (make_setup, ONES, {"lights": []}),
    (choose, None, {}),
    (choose, None, {"count": 4, "target": 1.0}),
    (choose, None, {"count": 41}),
    (choose, None, {"target": float("nan")}),
    (choose, None, {"count": 4, "method": "unform"}),
    (fit_weights, None, {"wavelengths": []}),
    (fit_weights, None, {"wavelengths": [500, 500]}),
    (fit_weights, None, {"wavelengths": [300, 500]}),
    (fit_weights, None, {"wavelengths": [np.nan]}),
]


@pytest.mark.parametrize(("function", "materials", "options"), INVALID)
def test_invalid_input_is_refused(smooth, function, materials, options):
    with raises(UpliftError):
        function(smooth if materials is None else materials, **options)
