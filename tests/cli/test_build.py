"""``uplift build``: defaults that just work, a quiet pipe, refusals before the work."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

import uplift

from .conftest import MACBETH

TINY = ("--dim", 3)


def test_the_cube_is_named_after_the_atlas_and_lies_here(run, elsewhere):
    result = run("build", "--atlas", MACBETH, "--dim", 6)
    assert result.stdout.startswith("macbeth-6.uplift: 216 points, 23 atlas entries, all within 0.0001")
    assert uplift.load(elsewhere / "macbeth-6.uplift").data.lattice.dim == 6
    assert "warning: entry 'cyan' is left out" in result.stderr


def test_without_an_atlas_it_is_named_after_the_space(run, elsewhere):
    run("build", *TINY, "--model", "sigmoid")
    assert os.listdir(elsewhere) != []
    assert uplift.load("srgb-3.uplift").data.model.name == "sigmoid"


def test_options_arrive(run):
    run("build", *TINY, "--moments", 4, "--warp", "vision", "--axis", "linear", "--space", "P3-D65")
    data = uplift.load("p3-d65-3.uplift").data
    assert (data.model.count, data.model.phase.warp) == (5, "vision")
    assert data.lattice.nodes.tolist() == [0, 0.5, 1]
    assert data.sensor.space == "P3-D65"
    assert data.round is None


def test_lights_arrive(run):
    run("build", "--atlas", MACBETH, *TINY, "--light", "A", "--light", "HP1", "-o", "a.uplift")
    assert uplift.load("a.uplift").data.provenance["options"]["lights"] == ["A", "HP1"]


def test_several_atlases_make_one_cube(run):
    pmc = MACBETH.replace("macbeth", "pmc")
    run("build", "--atlas", MACBETH, "--atlas", pmc, *TINY)
    data = uplift.load("macbeth+pmc-3.uplift").data
    assert {"orange", "PMC Orange"} <= set(data.atlas.names)


def test_quiet_is_quiet(run):
    result = run("build", *TINY, "-q")
    assert (result.stdout, result.stderr) == ("", "")


def test_verbose_tells_every_round_and_every_improvement(run):
    lines = run("build", "--dim", 8, "-v").stderr.splitlines()
    assert lines[0] == "round 0: tried 1, fitted 1 of 512"
    assert any(line.startswith("improvement, more iterations: tried ") for line in lines)


def test_no_progress_bar_where_there_is_no_terminal(run):
    assert run("build", *TINY).stderr == ""


def test_an_existing_cube_is_kept_without_force(run, refused):
    run("build", *TINY, "-q")
    before = os.stat("srgb-3.uplift").st_mtime_ns
    assert "srgb-3.uplift: exists already; use --force" in refused("build", *TINY)
    assert os.stat("srgb-3.uplift").st_mtime_ns == before
    run("build", *TINY, "-q", "--force")


def test_the_same_input_gives_the_same_bytes(run, elsewhere):
    for name in ("a", "b"):
        run("build", "--atlas", MACBETH, *TINY, "-o", name, "-q")
    assert (elsewhere / "a").read_bytes() == (elsewhere / "b").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--dim", 1), "dim 1 has no cells; use --dim 2 or more"),
        (("--dim", 0), "dim 0"),
        (("--dim", -5), "dim -5"),
        (("--dim", 5000), "GB of memory"),
        (("--moments", 1), "3 to 17"),
        (("--moments", 17), "3 to 17"),
        (("--model", "sigmiod"), "did you mean 'sigmoid'"),
        (("--illuminant", "D56"), "unknown illuminant 'D56'; did you mean"),
        (("--space", "sRBG"), "did you mean 'sRGB'"),
        (("--observer", "CIE 1913"), "unknown observer"),
        (("--light", "FL111"), "did you mean 'FL11'"),
        (("--warp", "eye"), "unknown warp 'eye'"),
        (("--axis", "cubic"), "axis spacing"),
        (("--threshold", "nan"), "threshold"),
        (("--atlas", "none.txt"), "none.txt"),
        (("-o", "nowhere/a.uplift"), "no folder"),
        (("-o", "."), "no regular file"),
    ],
)
def test_bad_input_is_refused_in_one_line_and_nothing_is_written(refused, elsewhere, arguments, message):
    dim = () if "--dim" in arguments else TINY
    assert message in refused("build", *dim, *arguments)
    assert os.listdir(elsewhere) == []


@pytest.mark.parametrize(
    "content", ["", "   \n", "no atlas at all", "Entry ID: half\n---\nType : reflectance spectrum\n"]
)
def test_a_bad_atlas_is_refused_with_its_place(refused, elsewhere, content):
    (elsewhere / "bad.txt").write_text(content)
    assert "bad.txt" in refused("build", "--atlas", "bad.txt", *TINY)
    assert os.listdir(elsewhere) == ["bad.txt"]


def test_a_refusal_comes_before_the_work(refused, elsewhere):
    """A dim that would take hours, refused at once for its output."""
    begin = time.perf_counter()
    refused("build", "--dim", 128, "-o", "nowhere/a.uplift")
    assert time.perf_counter() - begin < 5


def test_a_killed_build_leaves_the_old_cube_whole(run, elsewhere):
    run("build", *TINY, "-o", "cube.uplift", "-q")
    before = (elsewhere / "cube.uplift").read_bytes()
    command = [
        sys.executable,
        "-m",
        "uplift_cli",
        "build",
        "--dim",
        "40",
        "-o",
        "cube.uplift",
        "--force",
        "-v",
    ]
    child = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert child.stderr.readline().startswith("round 0")
    child.send_signal(signal.SIGKILL)
    child.communicate()
    assert child.returncode == -signal.SIGKILL
    assert (elsewhere / "cube.uplift").read_bytes() == before
