"""Sensitivity to queries and atlases."""

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.lab.study.sensitivity import (
    CONTINUOUS_MODES,
    perturb,
    perturb_answers,
)

LIGHT = observer.light("FL11")


def test_answers_change_in_proportion_to_the_query_and_do_not_jump(plain_cube):
    rows = perturb(plain_cube, 200)
    steps = (rows[::3], rows[1::3], rows[2::3])
    assert [row["mode"] for row in rows[::3]] == list(CONTINUOUS_MODES)
    for wide, narrow, rounding in zip(*steps, strict=True):
        assert wide["rms_mean"] == pytest.approx(4 * narrow["rms_mean"], rel=0.1)
        assert wide["own_mean"] == pytest.approx(4 * narrow["own_mean"], rel=0.05)
        assert 0 < rounding["rms_most"] < 1e-5
        assert 0 < rounding["light_most"] < 1e-2
        assert wide["rms_mean"] < wide["rms_most"] < wide["largest"]
    assert max(row["jump"] for row in rows) < 2e-3


@pytest.mark.parametrize("width", [1e-12, 0.004])
def test_jumps_are_found_and_only_those(width):
    """Answers that change at a red of 0.5, suddenly or as steeply as the step of a
    code.
    """
    dark = np.full(81, 0.2)
    bright = np.linspace(0.2, 0.5, 81)

    def answer(rgb):
        return dark + np.clip((rgb[:, :1] - 0.5) / width, 0, 1) * (bright - dark)

    lights = LIGHT, observer.light("D65")
    jump = perturb_answers("", answer, lambda codes: codes / 255, lights)[0]["jump"]
    expected = float(delta_e_spectra(LIGHT, dark, bright))
    assert jump == pytest.approx(expected * (width < 1e-6), abs=1e-3 * expected)
