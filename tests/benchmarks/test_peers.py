"""Checks of other tools' answers, and rows of tools that are absent, crash or hang."""

import os
import shutil
import time

import numpy as np
import pytest

from benchmarks.peers import Peer, alone, ceres, judge

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


def test_absent_tools_have_rows_without_figures(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    rows = ceres(1)
    assert [(row.cpu_us, row.share, row.worst) for row in rows] == [(None, None, None)] * 3
    assert all("not installed" in row.notes for row in rows)


def abort(runs: int) -> list[Peer]:
    os.abort()


def hang(runs: int) -> list[Peer]:
    time.sleep(600)
    return []


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("tool", "seconds", "why"), [(abort, 60, "crashed: signal 6"), (hang, 0.5, "no answer within 0.5 s")]
)
def test_a_tool_that_crashes_or_hangs_has_a_row(tool, seconds, why):
    (row,) = alone(tool, 1, seconds)
    assert (row.tool, row.cpu_us, row.notes) == (tool.__name__, None, why)
