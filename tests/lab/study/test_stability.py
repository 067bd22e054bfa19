"""Stability study: evaluation of builds, the design, and the pointwise solver."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.common.errors import OptionError, UnknownNameError
from uplift.common.progress import Progress
from uplift.lab.study import stability
from uplift.lab.study.pointwise import (
    IN_MOMENTS,
    IN_MULTIPLIERS,
    NoDerivativeError,
    PointwiseProblem,
    fit_pointwise,
)
from uplift.lab.study.stability import (
    NO_ATLAS,
    QUICK_DESIGN,
    SPACES,
    UPLIFT,
    DesignSpace,
    RunConfig,
    RunResult,
    design,
    draw_sample,
    grids,
    run,
    solver_runs,
    study_stability,
)
from uplift.lattice import Lattice
from uplift.models import Moments


def test_build_is_evaluated_over_its_realisable_points():
    result = run(RunConfig(dim=4, space="ITU-R BT.2020"), {})
    sensor, lattice = observer.sensor("ITU-R BT.2020"), Lattice(observer.axis_nodes("srgb", 4))
    assert result.points == 64
    assert result.realisable == solid(sensor.matrix).contains(lattice.points).sum() < 64
    assert (result.unfitted, result.stand_ins, result.success) == (0, 0, 1)
    assert result.worst <= result.config.threshold
    assert lattice.points.tolist().count([result.r, result.g, result.b]) == 1


def test_failed_points_are_counted_and_the_worst_is_reported():
    points = np.array([[0.0, 0, 0], [0.5, 0.5, 0.5], [1, 1, 1], [0, 1, 0]])
    realisable = np.array([True, True, True, False])
    distance = np.array([2e-4, 1e-5, 3e-3, 0.5])
    result = stability._evaluate(RunConfig(), points, realisable, distance, stand_ins=1, rounds=2, calls=3, seconds=4.0)
    assert (result.points, result.realisable, result.unfitted, result.stand_ins) == (4, 3, 2, 1)
    assert (result.worst, result.r, result.g, result.b) == (3e-3, 1, 1, 1)
    assert result.success == pytest.approx(1 / 3)
    assert result.record() == {
        **{"model": "moments", "coefficients": 9, "dim": 17, "space": "sRGB", "threshold": 1e-4},
        **{"atlas": NO_ATLAS, "solver": "uplift", "success": result.success},
        **{"points": 4, "realisable": 3, "unfitted": 2, "stand_ins": 1, "rounds": 2, "calls": 3},
        **{"worst": 3e-3, "r": 1, "g": 1, "b": 1, "seconds": 4.0},
    }


def test_study_runs_every_configuration_once_ordered_by_model(monkeypatch):
    configs = [RunConfig(dim=8), RunConfig("sigmoid", 3), RunConfig(dim=4), RunConfig(dim=8)]
    runs, events = [], []

    def fake_run(config, atlases):
        runs.append(config)
        return RunResult(config, 1, 1, 0, 0, 0, 0, 0.0, 0, 0, 0, 0.0)

    monkeypatch.setattr(stability, "run", fake_run)
    result = study_stability(configs, {}, events.append)
    assert [one.config for one in result] == runs == [configs[2], configs[0], configs[1]]
    assert events == [Progress("builds", done, 3) for done in (1, 2, 3)]


def test_design_contains_grids_sample_and_solver_runs_once():
    axes = DesignSpace(samples=10)
    result = design(axes)
    assert len(set(result)) == len(result)
    for grid in grids(axes):
        for _, row in grid.rows():
            assert set(row) <= set(result)
            assert [getattr(setting, grid.axis) for setting in row] == list(grid.values)
    assert len(draw_sample(axes)) == 10
    assert draw_sample(axes) == draw_sample(axes)
    assert {setting.solver for setting in solver_runs(axes)} == {UPLIFT, IN_MOMENTS, IN_MULTIPLIERS}
    five = {(setting.space, setting.model) for setting in result if setting.dim == 17}
    assert five >= {(space, model) for space in SPACES for model in ("moments", "sigmoid")}


def test_design_uses_only_the_given_values():
    axes = DesignSpace(dims=(6,), spaces=("ACEScg",), models=("sigmoid",), thresholds=(1e-3,), atlases=(NO_ATLAS,))
    assert design(axes) == (RunConfig("sigmoid", 3, 6, "ACEScg", 1e-3),)
    assert len(design(QUICK_DESIGN)) < len(design(DesignSpace())) / 3
    with raises(OptionError, "empty-axis"):
        DesignSpace(spaces=())


def test_sample_covers_every_value_of_every_axis():
    """A Latin hypercube of 12 has two points or more for each of up to five values of an axis."""
    space = DesignSpace()
    sample = draw_sample(space)
    assert len(sample) == space.samples == 12
    for name, values in (
        ("dim", [dim for dim in space.dims if dim <= 17]),
        ("space", space.spaces),
        ("threshold", space.thresholds),
        ("atlas", space.atlases),
        ("model_label", [variant.model_label for variant in space.variants]),
    ):
        assert {getattr(config, name) for config in sample} == set(values), name


def test_sample_of_a_small_space_is_all_of_it():
    space = DesignSpace(dims=(4,), coefficients=(3,), spaces=("sRGB",), atlases=(NO_ATLAS,), samples=100)
    assert len(draw_sample(space)) == 2 * 5


def test_unknown_atlas_raises_before_any_build(monkeypatch):
    monkeypatch.setattr(stability, "run", lambda *args: pytest.fail("a build ran"))
    with raises(UnknownNameError, "unknown-atlas"):
        study_stability([RunConfig(), RunConfig(atlas="paint")], {})


def test_multipliers_fit_more_points_than_moments():
    lattice, threshold = Lattice(observer.axis_nodes("srgb", 3)), 1e-4
    in_moments, in_multipliers = (
        fit_pointwise(PointwiseProblem(Moments(5), observer.sensor(), unknowns), lattice, threshold)
        for unknowns in (IN_MOMENTS, IN_MULTIPLIERS)
    )
    failed = [int((result.distance > threshold).sum()) for result in (in_moments, in_multipliers)]
    assert failed[1] < failed[0] < lattice.size / 2
    assert in_multipliers.distance.max() < 0.2 * in_moments.distance.max() < 0.2
    assert in_moments.starts > in_multipliers.starts >= lattice.size


@pytest.mark.parametrize("unknowns", [IN_MOMENTS, IN_MULTIPLIERS])
def test_jacobian_agrees_with_wider_differences(unknowns):
    problem = PointwiseProblem(Moments(5), observer.sensor(), unknowns)
    x, rgb = problem.grey + np.array([0.01, -0.02, 0.03, 0.01, 0]), np.full(3, 0.4)
    result = problem.jacobian(x, rgb)
    for column, step in enumerate(1e-4 * np.eye(5)):
        difference = problem.residuals(x + step, rgb) - problem.residuals(x - step, rgb)
        np.testing.assert_allclose(result[:, column], difference / 2e-4, atol=1e-5)


def test_solver_in_moments_stops_at_their_boundary():
    problem = PointwiseProblem(Moments(5), observer.sensor(), IN_MOMENTS)
    outside = np.array([1.2, 0, 0, 0, 0])
    assert np.abs(problem.residuals(outside, np.zeros(3))).max() == 1
    with raises(NoDerivativeError, "no-derivative"):
        problem.jacobian(outside, np.zeros(3))
    np.testing.assert_array_equal(problem.solve(np.ones(3), outside), outside)
