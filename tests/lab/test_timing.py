"""Numbers with a spread, and where they were taken."""

from __future__ import annotations

import subprocess

import pytest

from uplift.lab import timing


def test_a_spread_is_median_least_and_most():
    found = timing.spread([3.0, 1.0, 2.0])
    assert (found.median, found.least, found.most, found.runs) == (2, 1, 3, 3)
    assert f"{found.scaled(10):.0f}" == "20 (10–30)"


def test_every_run_is_timed():
    calls = []
    wall, cpu = timing.timed(lambda: calls.append(1), 4)
    assert len(calls) == wall.runs == cpu.runs == 4
    assert 0 <= wall.least <= wall.median <= wall.most


def test_circumstances_name_machine_versions_and_commit():
    found = timing.environment()
    assert "cores" in found["machine"]
    assert "numpy" in found["versions"]
    assert found["commit"]


@pytest.mark.parametrize("repository", [False, True])
def test_code_outside_a_working_tree_of_its_own_is_of_no_commit(tmp_path, monkeypatch, repository):
    if repository:  # that knows nothing of this code, as where a package is installed below another project
        subprocess.run(["git", "init", "-q", tmp_path], check=True)
    copy = tmp_path / "timing.py"
    copy.write_text("")
    monkeypatch.setattr(timing, "SOURCES", tmp_path)
    monkeypatch.setattr(timing, "__file__", str(copy))
    assert timing.commit() == "unknown"
