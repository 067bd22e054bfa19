"""The search finds the best candidate."""

from __future__ import annotations

import pytest

from uplift.lab.comparison.compare import error_statistics
from uplift.lab.comparison.filters import NONE, tune_filters
from uplift.scene.representations.filters import COARSE_STRIDE, candidates, filtered_point_samples
from uplift.scene.representations.samples import point_samples


@pytest.fixture(scope="module")
def tuned(checker):
    return {
        (one.lights, one.kind): one
        for one in tune_filters(checker, COARSE_STRIDE, ("tent", "lanczos", "mitchell"), (16,))
    }


@pytest.mark.parametrize("lights", ["smooth", "spiky"])
@pytest.mark.parametrize("kind", ["tent", "lanczos"])
def test_no_candidate_is_better(checker, tuned, lights, kind):
    (part,) = [part for part in checker.sets if part.name == lights]
    means = {
        one: error_statistics(filtered_point_samples(16, one), checker, part).mean
        for one in candidates(kind, COARSE_STRIDE)
    }
    best = tuned[lights, kind]
    assert best.low_pass == min(means, key=means.__getitem__)
    assert best.statistics.mean == pytest.approx(min(means.values()), rel=1e-9)


def test_without_a_filter_results_are_those_of_point_sampling(checker, tuned):
    for part in checker.sets:
        assert tuned[part.name, NONE].statistics == error_statistics(point_samples(16), checker, part)
        assert tuned[part.name, NONE].parameters == ""


def test_filters_improve_point_sampling_under_spiky_lights(tuned):
    for kind in ("mitchell", "lanczos"):
        assert tuned["spiky", kind].statistics.mean < 0.3 * tuned["spiky", NONE].statistics.mean


def test_parameters_are_listed(tuned):
    assert tuned["spiky", "lanczos"].parameters.startswith("extent ")
    assert "τ" in tuned["spiky", "lanczos"].parameters
    assert tuned["spiky", "tent"].parameters.count(",") == 0
