"""Writers that are hurt: a few of what `make nightly` does many times."""

from __future__ import annotations

import os

import numpy as np
import pytest

from tests.fuzz import writers
from tests.fuzz.run import WRITERS, write

pytestmark = pytest.mark.skipif(os.name == "nt", reason="no SIGKILL there")


@pytest.mark.parametrize("target", [writers.killed_savers, writers.full_disks, writers.no_permission])
def test_the_old_file_or_a_whole_new_one(target):
    tally = write(target, 4 if target is writers.killed_savers else 1, seed=3)
    assert tally.inputs
    assert not tally.failures


def test_all_writers_are_attacked_by_night():
    assert len({target for target, _ in WRITERS}) == 5


def test_a_broken_file_would_be_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(
        writers, "SAVER", "import sys\nopen(sys.argv[1], 'w').write('half')\nprint()\ninput()"
    )
    tally = writers.killed_savers(2, np.random.default_rng(3), tmp_path)
    assert tally.failures == {"a broken file": 2}
