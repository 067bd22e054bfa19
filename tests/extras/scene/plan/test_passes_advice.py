"""How many passes of an RGB renderer a scene needs."""

import numpy as np

from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.materials import library_materials
from uplift.extras.scene.plan.passes_advice import advise_passes


def test_smaller_tolerances_need_more_passes():
    spectra = library_materials().held_out[::4]
    tolerances = (20, 2, 0.8, 0.4, 0.001)
    advice = [advise_passes(spectra, ["D65", "FL11"], t, 0.975) for t in tolerances]
    counts = [each.count for each in advice]
    assert counts == sorted(counts)
    assert counts[0] == 1
    assert counts[3] > 2
    assert counts[4] == max(PRESETS)
    for tolerance, each in zip(tolerances, advice, strict=True):
        assert each.within == (each.error <= tolerance) == (tolerance > 0.001)


def test_few_materials_judge_themselves():
    greys = np.array([[0.2], [0.5]]) * np.ones(81)
    advice = advise_passes(greys, ["A"], 1, 1)
    assert (advice.count, advice.within) == (1, True)
