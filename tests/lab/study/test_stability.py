"""Stability study: evaluation of builds, the design, and synthetic atlases that are as
difficult as their names.
"""

import numpy as np

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.object_colours import solid
from uplift.common.errors import UnknownNameError
from uplift.common.progress import Progress
from uplift.lab.study import stability
from uplift.lab.study.stability import (
    DESIGN,
    RunConfig,
    evaluate,
    study_stability,
    synthetic_atlases,
)
from uplift.lattice.lattice import Lattice, axis_nodes


def test_build_is_evaluated_over_its_realisable_nodes():
    result = evaluate(RunConfig(dim=4, space="ITU-R BT.2020"), {})
    nodes = Lattice(axis_nodes("srgb", 4)).points
    inside = solid(observer.sensor(result["space"]).matrix).contains(nodes)
    assert result["points"] == 64 > inside.sum() == result["realisable"]
    assert (result["unfitted"], result["stand_ins"], result["success"]) == (0, 0, 1)
    assert result["worst"] <= result["threshold"]
    assert nodes.tolist().count([result["r"], result["g"], result["b"]]) == 1


def test_study_runs_every_configuration_once_ordered_by_model(monkeypatch):
    first = RunConfig(dim=8)
    configs = [first, RunConfig("sigmoid", 3), RunConfig(dim=4), first]
    events = []
    monkeypatch.setattr(stability, "evaluate", lambda config, atlases: config)
    result = study_stability(configs, {}, events.append)
    assert result == [configs[2], configs[0], configs[1]]
    with raises(UnknownNameError, "unknown-name"):
        study_stability([*configs, RunConfig(atlas="paint")], {}, events.append)
    assert events == [Progress("builds", done, 3) for done in (1, 2, 3)]


def test_sample_covers_every_value_of_every_axis():
    """A Latin hypercube of 12 has two points or more for each of up to five values of
    an axis.
    """
    design = DESIGN.with_atlases(("macbeth", "noisy"))
    sample = list(design.sample())
    assert sample == list(design.sample())
    assert len(set(sample)) == design.samples == 12
    for name, values in design.axes.items():
        drawn = {getattr(config, name) for config in sample}
        assert drawn == {value for value in values if name != "dim" or value <= 17}
    models = {(config.model, config.coefficients) for config in sample}
    assert len(models) == len(design.variants)


def values_of(atlas):
    return np.array([entry.values for entry in atlas])


def test_atlases_are_crowded_spiky_and_noisy(sensor):
    crowded, spiky, noisy = map(values_of, synthetic_atlases().values())
    assert np.ptp(sensor.rgb(crowded), axis=0).max() < 0.1
    assert (np.abs(np.diff(spiky, axis=1)).max(axis=1) > 0.2).all()
    assert noisy.min() < 0 < 1 < noisy.max()
