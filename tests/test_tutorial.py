"""The tutorial runs: its commands and its Python, in order, in an empty folder."""

from __future__ import annotations

import re
import shlex

import pytest
from uplift_cli.main import main

import uplift
from tests.conftest import ROOT
from tests.parts import MITSUBA, need

TUTORIAL = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_the_tutorial_runs(tmp_path, monkeypatch):
    need(MITSUBA)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    blocks = re.findall(r"```(\w*)\n(.*?)```", TUTORIAL, re.DOTALL)
    assert [language for language, _ in blocks].count("python") == 2
    for language, block in blocks:
        if language == "python":
            exec(compile(block, "tutorial.md", "exec"), names)
        else:
            for line in block.splitlines():
                assert main.main(args=shlex.split(line)[1:], standalone_mode=False) in (None, 0), line
    written = {path.name for path in tmp_path.iterdir()}
    assert written >= {"orange.png", "macbeth-32.html", "chart.exr", "chart-moments.exr", "fl11.png"}
    assert uplift.load("macbeth-32.uplift").dim == 32
