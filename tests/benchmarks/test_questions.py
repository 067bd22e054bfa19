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
