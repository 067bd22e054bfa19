"""Short tests of interrupted writers, and the detection of broken files."""

from __future__ import annotations

import os
import signal

import numpy as np
import pytest

from tests.fuzz import signalled, writers
from tests.fuzz.run import WRITERS, stress_writer

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs SIGKILL")


@pytest.mark.parametrize("target", [writers.kill_saves, writers.full_disk, writers.no_permission])
def test_old_or_complete_new_file_remains(target):
    tally = stress_writer(target, 4 if target is writers.kill_saves else 1, seed=3)
    assert tally.inputs
    assert not tally.failures


def test_all_writer_tests_are_registered():
    assert len({target for target, _ in WRITERS.values()}) == 8


def test_builds_in_threads_give_equal_cubes():
    tally = stress_writer(writers.builds_in_threads, 1, seed=3)
    assert tally.inputs == writers.BUILDS + 1
    assert not tally.failures


def test_signals_that_are_ignored_are_counted(tmp_path, monkeypatch):
    ignored = dict.fromkeys((signal.SIGINT, signal.SIGTERM, signal.SIGHUP), signal.SIG_IGN)
    monkeypatch.setattr(signalled, "HANDLERS", ignored)
    monkeypatch.setattr(signalled, "SECONDS", 0.0)
    tally = signalled.end_builds(1, np.random.default_rng(3), tmp_path)
    assert tally.failures == {"it does not end": 1}


def test_broken_files_are_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(writers, "SAVE_IN_TURN", "import sys\nopen(sys.argv[1], 'w').write('half')\nprint()\ninput()")
    tally = writers.kill_saves(2, np.random.default_rng(3), tmp_path)
    assert tally.failures == {"a broken file": 2}
