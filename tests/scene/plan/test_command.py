# ruff: noqa: F811
"""``uplift plan`` and ``uplift build --plan``."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import pytest

from tests.cli.conftest import home, refuse, run, shown  # noqa: F401
from uplift.cube import read


@pytest.fixture
def here(home, kitchen, planned, monkeypatch):
    """A working folder with the scene, where plans are as they were measured once."""
    shutil.copytree(kitchen.parent, home, dirs_exist_ok=True)

    def plan(scene, progress):
        return replace(planned[0], scene=scene)

    monkeypatch.setattr("uplift.scene.plan.plan", plan)
    return home


def test_a_plan_is_printed_written_and_built(run, here):
    result = run("plan", "kitchen.toml")
    assert "kitchen.toml: ΔE00 " in result.stdout
    assert "uplift build --plan kitchen.plan.json" in result.stdout
    assert "kitchen.plan.json, kitchen.plan.html" in result.stderr
    values = json.loads((here / "kitchen.plan.json").read_text(encoding="utf-8"))
    assert (here / "kitchen.plan.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    built = run("build", "--plan", "kitchen.plan.json", "-v")
    assert "kitchen.uplift: " in built.stdout
    data = read(here / "kitchen.uplift")
    assert (data.lattice.dim, data.model.count) == (values["build"]["dim"], values["build"]["coefficients"])
    error = run("build", "--plan", "kitchen.plan.json", "--dim", 4, "--light", "A", code=2).stderr
    assert "leave out --dim, --light." in error


def test_json_output_equals_the_file(run, here):
    output = run("plan", "kitchen.toml", "--format", "json", "-o", "p.json").stdout
    assert json.loads(output) == json.loads((here / "p.json").read_text(encoding="utf-8"))
    assert (here / "p.html").exists()


def test_other_files_are_refused_as_plans(refuse, here):
    (here / "deep.json").write_text("[" * 100_000)
    for name, code in (
        ("wood.exr", "file-unreadable"),
        ("there.json", "file-not-found"),
        ("deep.json", "invalid-json"),
    ):
        error = refuse("build", "--plan", name)
        assert (error.code, error.where) == (code, name)
