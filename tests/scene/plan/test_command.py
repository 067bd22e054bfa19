# ruff: noqa: F811
"""``uplift plan`` and ``uplift build --plan``."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import pytest

from tests.cli.conftest import home, refuse, run  # noqa: F401
from uplift.cube import read


@pytest.fixture
def here(home, kitchen, planned, monkeypatch):
    """A working folder with the scene, where plans are as they were measured once."""
    shutil.copytree(kitchen.parent, home, dirs_exist_ok=True)

    def plan(scene, progress):
        return replace(planned[0], scene=scene)

    monkeypatch.setattr("uplift.scene.plan.plan", plan)
    return home


def test_a_plan_is_told_written_and_built(run, here):
    result = run("plan", "kitchen.toml")
    assert "kitchen.toml: ΔE00 " in result.stdout
    assert "uplift build --plan kitchen.plan.json" in result.stdout
    assert "kitchen.plan.json, kitchen.plan.html" in result.stderr
    said = json.loads((here / "kitchen.plan.json").read_text(encoding="utf-8"))
    assert (here / "kitchen.plan.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    built = run("build", "--plan", "kitchen.plan.json", "-v")
    assert "kitchen.uplift: " in built.stdout
    data = read(here / "kitchen.uplift")
    assert (data.lattice.dim, data.model.count) == (said["build"]["dim"], said["build"]["coefficients"])
    error = run("build", "--plan", "kitchen.plan.json", "--dim", 4, "--light", "A", code=2).stderr
    assert "the plan says all of that already: leave out --dim, --light." in error


def test_json_is_the_file(run, here):
    told = run("plan", "kitchen.toml", "--format", "json", "-o", "p.json").stdout
    assert json.loads(told) == json.loads((here / "p.json").read_text(encoding="utf-8"))
    assert (here / "p.html").exists()


def test_files_are_not_replaced_unasked(refuse, here):
    (here / "kitchen.plan.html").write_text("mine")
    assert "kitchen.plan.html: exists already; use --force" in refuse("plan", "kitchen.toml")


def test_what_is_wrong_with_the_scene_is_one_line(refuse, here):
    (here / "bad.toml").write_text('textures = "wood.exr"\ntolerence = 1\n')
    message = refuse("plan", "bad.toml")
    assert message.startswith("bad.toml:2: unknown key 'tolerence'; did you mean 'tolerance'")


def test_what_is_no_plan_is_refused(refuse, here):
    assert "wood.exr: is no plan of this version; plan again" in refuse("build", "--plan", "wood.exr")
    assert "there.json: cannot be read" in refuse("build", "--plan", "there.json")
    (here / "deep.json").write_text("[" * 100_000)
    assert "deep.json: is no plan of this version" in refuse("build", "--plan", "deep.json")
