"""Pages of measurements are answered question by question, and continued."""

import json
import sys
from types import SimpleNamespace

import pytest

import benchmarks
from benchmarks import __main__ as command


@pytest.fixture
def page(tmp_path, monkeypatch):
    """A page with two questions that count their calls, and one that fails."""
    calls = []
    questions = {
        "first": lambda: calls.append("first") or [{"n": 1}],
        "wrong": lambda: 1 / 0,
        "drawn": lambda: calls.append("drawn"),
    }
    monkeypatch.setitem(
        sys.modules, "benchmarks.sample_page", SimpleNamespace(QUESTIONS=questions)
    )
    monkeypatch.setattr(benchmarks, "DATA", tmp_path)
    machine = {"commit": "first"}
    monkeypatch.setattr(benchmarks, "commit", lambda: machine["commit"])
    monkeypatch.setattr(benchmarks, "environment", lambda: machine)
    path = tmp_path / "sample-page.json"
    return SimpleNamespace(calls=calls, machine=machine, path=path)


def test_questions_that_fail_or_are_unknown_do_not_stop_the_others(page):
    names = ["unknown", "first", "wrong", "drawn"]
    assert benchmarks.measure("sample-page", names) == 2
    assert page.calls == ["first", "drawn"]
    stored = json.loads(page.path.read_text("utf-8"))
    assert stored["first"] == [{"n": 1}]
    assert list(stored["measured"]) == ["first", "drawn"]


def test_only_stale_questions_are_answered_again(page):
    benchmarks.measure("sample-page", ["first", "drawn"])
    assert benchmarks.stale("sample-page") == ["wrong"]
    page.machine["commit"] = "second"
    assert benchmarks.stale("sample-page") == ["first", "wrong", "drawn"]


def test_an_unknown_page_is_an_error_before_anything_is_measured(monkeypatch):
    monkeypatch.setattr(command, "run", lambda *job: pytest.fail("measured"))
    assert command.main(["atlas-files", "nothing.at.all"]) == 2


def test_pages_that_fail_are_named_and_do_not_stop_the_others(monkeypatch):
    measured = {}
    monkeypatch.setattr(command, "UNTIMED", {"trust", "advice"})

    def run(page, names):
        measured[page] = names
        return page != "advice"

    monkeypatch.setattr(command, "run", run)
    jobs = command.jobs_of(["peers.ceres", "advice", "trust", "peers.ours"], [])
    assert command.run_all(jobs) == ["advice"]
    assert measured == {"advice": [], "trust": [], "peers": ["ceres", "ours"]}


def test_pages_that_share_the_machine_time_nothing():
    for name in command.UNTIMED & command.pages().keys():
        path = benchmarks.ROOT / "benchmarks" / f"{name.replace('-', '_')}.py"
        assert "timing import" not in path.read_text("utf-8")
