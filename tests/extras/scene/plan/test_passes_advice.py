"""How many passes of an RGB renderer a scene needs."""

import numpy as np
import pytest

from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.materials import library_materials
from uplift.extras.scene.plan.passes_advice import advise_passes
from uplift.extras.scene.plan.summary import notes, to_json


@pytest.fixture(scope="module")
def spectra():
    """Reflectances that are not those of the library's training half."""
    return library_materials().held_out[::4]


def test_smaller_tolerances_need_more_passes(spectra):
    counts = []
    for tolerance in (20, 2, 0.8, 0.4):
        advice = advise_passes(spectra, ["D65", "FL11"], tolerance, 0.975)
        assert advice.within
        assert advice.error <= tolerance
        counts.append(advice.count)
    assert counts == sorted(counts)
    assert counts[0] == 1
    assert counts[-1] > 2


def test_no_number_of_passes_is_enough(spectra):
    advice = advise_passes(spectra, ["D65"], 0.001, 0.975)
    assert not advice.within
    assert advice.count == max(PRESETS)


def test_few_materials_judge_themselves():
    greys = np.array([[0.2], [0.5]]) * np.ones(81)
    advice = advise_passes(greys, ["A"], 1, 1)
    assert (advice.count, advice.within) == (1, True)


def test_a_plan_states_the_passes(planned, kitchen):
    result, _ = planned
    fields = to_json(result, kitchen.with_suffix(".plan.json"))
    assert result.passes is not None
    assert fields["passes"]["count"] == result.passes.count
    assert any("'uplift passes'" in note for note in notes(result))
