"""All pages are measured by one command, which resumes and goes on after failures."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from click.testing import CliRunner

from benchmarks import measurements
from benchmarks.measurements import (
    COMPILED_ONCE,
    STEPS,
    Done,
    Journal,
    Outcome,
    describe,
    is_current,
    run_steps,
)
from tests.conftest import ROOT
from tools.render_docs import pages, read_data

GOOD = (sys.executable, "-c", "print('measured')")
BAD = (sys.executable, "-c", "import sys; print('no such atlas'); sys.exit(3)")


@pytest.fixture
def journal(tmp_path):
    return Journal(tmp_path / "measurements")


@pytest.fixture
def steps(tmp_path, monkeypatch):
    """Three steps that append their names to a file; the second fails until ``repaired`` exists."""
    (tmp_path / "Makefile").write_text(
        "one three docs:\n\t@echo $@ >> ran\n\ntwo:\n\t@echo $@ >> ran\n\t@test -e repaired\n"
    )
    monkeypatch.setattr(measurements, "STEPS", ("one", "two", "three"))
    monkeypatch.setattr(measurements, "ROOT", tmp_path)
    monkeypatch.setattr(measurements, "FOLDER", tmp_path / "out")
    monkeypatch.setattr(measurements, "commit", lambda: "abc")

    def run(*words):
        (tmp_path / "ran").write_text("")
        result = CliRunner().invoke(measurements.main, words)
        return result, (tmp_path / "ran").read_text().split()

    return run


def test_each_page_has_a_step_and_each_step_a_page():
    """The Makefile is the list of pages: its targets that render pages are the steps."""
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    recipes = re.findall(r"^([\w-]+):.*\n((?:\t.*\n)+)", text, re.MULTILINE)
    rendered = {
        name: match[1].split() for name, recipe in recipes if (match := re.search(r"tools\.render_docs (.+)", recipe))
    }
    assert set(STEPS) == set(rendered)
    assert len(set(STEPS)) == len(STEPS)
    measured = {name for name in pages() if read_data(name) and name != "errors"}
    assert measured <= {page for names in rendered.values() for page in names}


def test_each_measured_page_states_machine_and_commit():
    for name in pages():
        data = read_data(name)
        if data and name != "errors":
            assert {"machine", "versions", "commit"} <= set(data["environment"]), name
            assert data["environment"]["commit"] in (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def test_a_failure_is_named_and_the_others_run(journal, capfd):
    commands = {"one": GOOD, "two": BAD, "three": GOOD}
    assert run_steps(commands, journal, "abc") == Outcome(failed=("two",))
    assert set(journal.read()) == {"one", "three"}
    assert journal.log("two").read_text() == "no such atlas\n"
    assert "two failed with exit status 3" in capfd.readouterr().err


def test_a_run_goes_on_where_it_stopped(steps, tmp_path):
    result, ran = steps()
    assert ran == ["one", "two", "three", "docs"]
    assert result.exit_code == 1
    assert "failed: two" in result.output
    (tmp_path / "repaired").touch()
    result, ran = steps()
    assert (result.exit_code, ran) == (0, ["two", "docs"])
    assert steps()[1] == ["docs"]
    assert steps("three", "--again")[1] == ["three", "docs"]


def test_no_step_starts_that_cannot_end_in_time(journal):
    """A step that took 100 s is left; one without a duration starts unless the time is over."""
    journal.add("long", Done("old", 100.0, ""))
    journal.add("short", Done("old", 1.0, ""))
    commands = dict.fromkeys(("long", "short", "new"), GOOD)
    assert run_steps(commands, journal, "abc", 50.0) == Outcome(left=("long",))
    assert {step for step, done in journal.read().items() if done.commit == "abc"} == {"short", "new"}
    assert run_steps(commands, journal, "abc", 0.0) == Outcome(left=("long", "short", "new"))
    assert run_steps(commands, journal, "abc") == Outcome()


def test_what_the_time_does_not_suffice_for_is_named(steps, tmp_path):
    (tmp_path / "repaired").touch()
    result, ran = steps("--minutes", "0")
    assert (result.exit_code, ran) == (0, ["docs"])
    assert "no time for one, two, three" in result.output
    assert "at one commit" not in result.output
    assert "at one commit" in steps("--minutes", "10")[0].output


def test_steps_share_compiled_code_unless_they_time_it(journal, monkeypatch):
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    show = (sys.executable, "-c", "import os; print(os.environ.get('JAX_COMPILATION_CACHE_DIR'))")
    assert run_steps({"study": show, "bench": show}, journal, "abc") == Outcome()
    assert journal.log("study").read_text() == f"{journal.folder / 'compiled'}\n"
    assert journal.log("bench").read_text() == "None\n"
    assert set(STEPS) >= COMPILED_ONCE


def test_another_commit_or_changed_files_repeat_all(steps, tmp_path, monkeypatch):
    (tmp_path / "repaired").touch()
    for commit in ("abc", "def", "def with changes", "def with changes"):
        monkeypatch.setattr(measurements, "commit", lambda commit=commit: commit)
        assert steps()[1] == ["one", "two", "three", "docs"]


def test_listing_measures_nothing(steps):
    steps("one")
    result, ran = steps("--list")
    assert ran == []
    assert re.search(r"one: 0:00:0\d, .*, commit abc\ntwo: not measured", result.output)


def test_an_unknown_step_is_an_error(steps):
    result, ran = steps("four")
    assert (result.exit_code, ran) == (1, [])
    assert "no step 'four'" in result.output


def test_a_step_is_current_at_its_commit_only():
    done = Done("abc", 61.0, "2026-01-01 12:00")
    assert is_current(done, "abc")
    assert not is_current(done, "def")
    assert not is_current(None, "abc")
    assert describe("one", done) == "one: 0:01:01, 2026-01-01 12:00, commit abc"


def test_steps_can_be_listed_from_the_command_line():
    command = [sys.executable, "-m", "benchmarks.measurements", "--list"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert [line.split(":")[0] for line in done.stdout.splitlines()] == list(STEPS)
