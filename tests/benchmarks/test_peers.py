"""Checks of other tools' answers, and a tool that is missing."""

import shutil

import numpy as np
import pytest

from benchmarks.peers import ceres, judge

TARGET = np.full((10, 3), 0.5)


def test_judge_returns_the_share_and_the_largest_residual():
    found = TARGET.copy()
    found[0, 1] += 2e-4
    assert judge(found, TARGET, least=0.9) == {"share": 0.9, "worst": pytest.approx(2e-4)}


@pytest.mark.parametrize("wrong", [0.6, np.nan])
def test_judge_raises_on_a_wrong_answer(wrong):
    found = TARGET.copy()
    found[:2, 0] = wrong
    with pytest.raises(RuntimeError, match=r"80\.0% of the points"):
        judge(found, TARGET, least=0.9)


def test_a_missing_tool_is_an_error_not_a_row_without_figures(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(RuntimeError, match="libceres-dev"):
        ceres(1)
