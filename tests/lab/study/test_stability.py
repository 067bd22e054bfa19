"""The failure map: builds are judged by what they hold, and the design is what it says."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.common.errors import OptionError, UpliftError
from uplift.lab.study import stability
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS, PointwiseProblem, fit_pointwise
from uplift.lab.study.stability import NO_ATLAS, RunConfig, RunResult, run, study_stability
from uplift.lab.study.stability_design import (
    QUICK_DESIGN,
    SPACES,
    DesignSpace,
    design,
    draw_sample,
    grids,
    solver_runs,
)
from uplift.lattice import Lattice
from uplift.models import Moments


def test_a_build_is_judged_over_its_realisable_points():
    found = run(RunConfig(dim=4, space="ITU-R BT.2020"), {})
    sensor, lattice = observer.sensor("ITU-R BT.2020"), Lattice(observer.axis_nodes("srgb", 4))
    assert found.points == 64
    assert found.realisable == solid(sensor.matrix).contains(lattice.points).sum() < 64
    assert (found.unfitted, found.stand_ins, found.success) == (0, 0, 1)
    assert found.worst <= found.setting.threshold
    assert lattice.points.tolist().count([found.r, found.g, found.b]) == 1


def test_points_that_fail_are_counted_and_the_worst_is_named():
    points = np.array([[0.0, 0, 0], [0.5, 0.5, 0.5], [1, 1, 1], [0, 1, 0]])
    realisable = np.array([True, True, True, False])
    distance = np.array([2e-4, 1e-5, 3e-3, 0.5])
    found = stability._judge(RunConfig(), points, realisable, distance, 1, 2, 3, 4.0)
    assert (found.points, found.realisable, found.unfitted, found.stand_ins) == (4, 3, 2, 1)
    assert (found.worst, found.r, found.g, found.b) == (3e-3, 1, 1, 1)
    assert found.success == pytest.approx(1 / 3)
    assert found.record() == {
        **{"model": "moments", "coefficients": 9, "dim": 17, "space": "sRGB", "threshold": 1e-4},
        **{"atlas": NO_ATLAS, "solver": "uplift", "success": found.success},
        **{"points": 4, "realisable": 3, "unfitted": 2, "stand_ins": 1, "rounds": 2, "calls": 3},
        **{"worst": 3e-3, "r": 1, "g": 1, "b": 1, "seconds": 4.0},
    }


def test_a_study_runs_every_setting_once_model_by_model(monkeypatch):
    settings = [RunConfig(dim=8), RunConfig("sigmoid", 3), RunConfig(dim=4), RunConfig(dim=8)]
    ran, heard = [], []

    def pretend(setting, atlases):
        ran.append(setting)
        return RunResult(setting, 1, 1, 0, 0, 0, 0, 0.0, 0, 0, 0, 0.0)

    monkeypatch.setattr(stability, "run", pretend)
    found = study_stability(settings, {}, lambda done, total: heard.append((done, total)))
    assert [one.setting for one in found] == ran == [settings[2], settings[0], settings[1]]
    assert heard == [(1, 3), (2, 3), (3, 3)]


def test_the_design_holds_its_grids_its_sample_and_its_peers_once():
    axes = DesignSpace(drawn=10)
    found = design(axes)
    assert len(set(found)) == len(found)
    for grid in grids(axes):
        for _, row in grid.rows():
            assert set(row) <= set(found)
            assert [getattr(setting, grid.axis) for setting in row] == list(grid.values)
    assert len(draw_sample(axes)) == 10
    assert draw_sample(axes) == draw_sample(axes)
    assert {setting.solver for setting in solver_runs(axes)} == {"uplift", IN_MOMENTS, IN_MULTIPLIERS}
    five = {(setting.space, setting.model) for setting in found if setting.dim == 17}
    assert five >= {(space, model) for space in SPACES for model in ("moments", "sigmoid")}


def test_the_design_keeps_to_what_is_chosen():
    axes = DesignSpace(
        dims=(6,), spaces=("ACEScg",), models=("sigmoid",), thresholds=(1e-3,), atlases=(NO_ATLAS,)
    )
    assert design(axes) == (RunConfig("sigmoid", 3, 6, "ACEScg", 1e-3),)
    assert len(design(QUICK_DESIGN)) < len(design(DesignSpace())) / 3
    with pytest.raises(OptionError, match="no spaces"):
        DesignSpace(spaces=())


def test_multipliers_reach_where_moments_stop():
    lattice, threshold = Lattice(observer.axis_nodes("srgb", 3)), 1e-4
    in_moments, in_multipliers = (
        fit_pointwise(PointwiseProblem(Moments(5), observer.sensor(), unknowns), lattice, threshold)
        for unknowns in (IN_MOMENTS, IN_MULTIPLIERS)
    )
    failed = [int((found.distance > threshold).sum()) for found in (in_moments, in_multipliers)]
    assert failed[1] < failed[0] < lattice.size / 2
    assert in_multipliers.distance.max() < 0.2 * in_moments.distance.max() < 0.2
    assert in_moments.starts > in_multipliers.starts >= lattice.size


@pytest.mark.parametrize("unknowns", [IN_MOMENTS, IN_MULTIPLIERS])
def test_differences_are_the_derivative(unknowns):
    task = PointwiseProblem(Moments(5), observer.sensor(), unknowns)
    x, rgb = task.grey + np.array([0.01, -0.02, 0.03, 0.01, 0]), np.full(3, 0.4)
    found = task.differences(x, rgb)
    for row, way in enumerate(np.eye(5)):
        ahead, behind = task.miss(x + 1e-4 * way, rgb), task.miss(x - 1e-4 * way, rgb)
        np.testing.assert_allclose(found[:, row], (ahead - behind) / 2e-4, atol=1e-5)


def test_a_solver_in_moments_stops_at_their_boundary():
    task = PointwiseProblem(Moments(5), observer.sensor(), IN_MOMENTS)
    beyond = np.array([1.2, 0, 0, 0, 0])
    assert np.abs(task.miss(beyond, np.zeros(3))).max() == 1
    with pytest.raises(UpliftError):
        task.differences(beyond, np.zeros(3))
    np.testing.assert_array_equal(task.solve(np.ones(3), beyond), beyond)
