"""What tests set for their process ends with their module."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT
from tests.parts import MITSUBA, need
from tests.process_state import kept_process_state

LEAVES = """
import os
def test_leaves(tmp_path):
    os.chdir(tmp_path)
    os.environ["OMP_NUM_THREADS"] = "7"
    del os.environ["KEPT"]
"""
FINDS = """
import os
from pathlib import Path
def test_finds():
    assert Path.cwd() == Path(__file__).parent
    assert "OMP_NUM_THREADS" not in os.environ
    assert os.environ["KEPT"] == "1"
"""


@pytest.mark.parametrize(("fixture", "failed"), [("_process_state", 0), ("", 1)])
def test_modules_leave_nothing_to_later_ones(tmp_path, fixture, failed):
    (tmp_path / "conftest.py").write_text(f"from tests.conftest import {fixture}" if fixture else "")
    (tmp_path / "test_a.py").write_text(LEAVES)
    (tmp_path / "test_b.py").write_text(FINDS)
    clean = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", tmp_path, tmp_path]
    environment = clean | {"KEPT": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == failed, done.stdout + done.stderr


def test_the_variant_of_mitsuba_is_restored():
    need(MITSUBA)
    import mitsuba

    mitsuba.set_variant("scalar_spectral")
    with kept_process_state():
        mitsuba.set_variant("scalar_rgb")
    assert mitsuba.variant() == "scalar_spectral"
