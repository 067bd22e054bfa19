"""``uplift build``."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import uplift
from uplift.pipeline.options import Options

SMALL = ("--dim", "4", "--moments", "3")


def uplift_process(*args):
    code = "from uplift_cli.main import main; main()"
    return [sys.executable, "-c", code, *map(str, args)]


def test_a_cube_is_written_and_told_in_a_line(run, home):
    result = run("build", *SMALL, "-o", "cube.uplift")
    assert os.listdir(home) == ["cube.uplift"]
    data = uplift.load(home / "cube.uplift").data
    assert (data.lattice.dim, data.model.count, data.points.round) == (4, 4, None)
    assert result.stdout.startswith("cube.uplift: 64 points, all within 0.0001 (worst ")
    assert result.stdout.count("\n") == 1
    assert result.stderr == ""


def test_help_names_the_lights_that_are_the_default(run):
    assert f"[default: {' '.join(Options.lights)}]" in " ".join(run("build", "--help").stdout.split())


def test_colours_that_no_reflectance_has_are_told_of(run, home):
    result = run("build", "--dim", "3", "--space", "ITU-R BT.2020", "-o", "wide.uplift")
    beyond = uplift.load(home / "wide.uplift").data.points.counts()["unrealisable"]
    assert beyond > 0
    assert f"all within 0.0001 but {beyond} that no reflectance has the colour of" in result.stdout
    asked = run("query", "--cube", "wide.uplift", "0", "1", "0").stdout
    assert "realisable  no: no reflectance has this colour, the answer has less chroma\n" in asked
    assert "no reflectance" not in run("query", "--cube", "wide.uplift", "0.5", "0.5", "0.5").stdout


@pytest.mark.parametrize(
    ("args", "name"),
    [
        ((), "srgb-2.uplift"),
        (("--space", "Display P3"), "display-p3-2.uplift"),
        (("--space", "Pal/Secam"), "pal-secam-2.uplift"),
        (("--atlas", "a.csv"), "a-2.uplift"),
        (("--atlas", "a.csv", "--atlas", "far/b.csv"), "a+b-2.uplift"),
    ],
)
def test_the_default_name_is_that_of_atlas_or_space_and_dim(run, home, args, name):
    (home / "far").mkdir()
    (home / "a.csv").write_text("name,380,780\ngrey,0.5,0.5\n")
    (home / "far" / "b.csv").write_text("name,380,780\nblack,0.01,0.01\n")
    run("build", "--dim", "2", "--moments", "3", *args)
    assert {path.name for path in home.iterdir()} - {"a.csv", "far"} == {name}


def test_every_option_reaches_the_cube(run, home):
    run("build", "--dim", "3", "--moments", "4", "--warp", "vision", "--axis", "linear", "--space", "Display P3",
        "--illuminant", "D50", "--observer", "CIE 1964 10 Degree Standard Observer", "--light", "A",
        "--light", "FL2", "--threshold", "1e-3", "--debug", "-o", "cube")  # fmt: skip
    data = uplift.load(home / "cube").data
    assert data.model == uplift.models.Moments(5, uplift.models.Phase(warp="vision"))
    np.testing.assert_array_equal(data.lattice.nodes, [0, 0.5, 1])
    assert (data.sensor.space, data.sensor.illuminant) == ("Display P3", "D50")
    assert data.sensor.observer == "CIE 1964 10 Degree Standard Observer"
    assert data.threshold == 1e-3
    assert data.points.round is not None
    assert data.provenance["options"]["lights"] == ["A", "FL2"]


def test_the_sigmoid_is_a_model_too(run, home):
    run("build", "--dim", "3", "--model", "sigmoid", "-o", "cube")
    assert uplift.load(home / "cube").data.model.name == "sigmoid"


def test_the_same_input_gives_the_same_bytes(run, home, macbeth):
    for name in ("a", "b"):
        run("build", "--atlas", macbeth, *SMALL, "-o", name)
    assert (home / "a").read_bytes() == (home / "b").read_bytes()


def test_entries_out_of_gamut_are_warned_of_and_counted(run, macbeth):
    result = run("build", "--atlas", macbeth, *SMALL, "-o", "cube")
    lines = result.stderr.splitlines()
    assert (
        lines[0]
        == "warning: entry 'cyan' is left out: its colour (-0.0334, 0.2488, 0.3855) lies outside sRGB"
    )
    assert all(line.startswith("warning: ") for line in lines)
    assert "23 atlas entries" in result.stdout


def test_quiet_says_nothing_but_warnings(run, macbeth):
    result = run("build", "-q", *SMALL, "-o", "plain")
    assert (result.stdout, result.stderr) == ("", "")
    result = run("build", "-q", "--atlas", macbeth, *SMALL, "-o", "cube")
    assert result.stdout == ""
    assert result.stderr.startswith("warning: entry 'cyan'")
    assert all(line.startswith("warning: ") for line in result.stderr.splitlines())


def test_verbose_tells_every_round(run):
    result = run("build", "-v", *SMALL, "-o", "cube")
    rounds = [line for line in result.stderr.splitlines() if line.startswith("round ")]
    assert rounds[0].startswith("round 0: tried ")
    assert [line.split(":")[0] for line in rounds] == [f"round {number}" for number in range(len(rounds))]
    assert "\x1b" not in result.stderr
    assert "\r" not in result.stderr


def test_existing_files_are_replaced_by_force_alone(run, refuse, home):
    (home / "cube").write_text("mine")
    assert refuse("build", *SMALL, "-o", "cube").startswith("cube: exists already; use --force")
    assert (home / "cube").read_text() == "mine"
    run("build", *SMALL, "-o", "cube", "--force")
    assert uplift.load(home / "cube").data.lattice.dim == 4


@pytest.mark.parametrize(
    ("args", "problem"),
    [
        (("-o", "none/cube"), "none/cube: the folder"),
        (("-o", "."), ".: is not a regular file; name a file"),
        (("-o", ""), ".: is not a regular file; name a file"),
        (("-o", "x" * 300), "xxx"),
        (("--dim", "1"), "a lattice of dim 1 has no cells; use --dim 2 or more"),
        (("--dim", "0"), "a lattice of dim 0 has no cells"),
        (("--dim", "-3"), "a lattice of dim -3 has no cells"),
        (("--dim", "100000"), "dim 100000 needs about 2.04e+08 GB of memory, this machine has "),
        (("--dim", "1000000000000"), "dim 1000000000000 needs about 2.04e+29 GB of memory"),
        (("--illuminant", "D66"), "unknown illuminant 'D66'; did you mean 'D65'"),
        (("--space", "sRGBB"), "unknown RGB space 'sRGBB'; did you mean 'sRGB'"),
        (("--space", "no/where"), "unknown RGB space 'no/where'; did you mean"),
        (("--observer", "CIE 1931"), "unknown observer 'CIE 1931'; did you mean"),
        (("--light", "FL99"), "unknown illuminant 'FL99'; did you mean 'FL9'"),
        (("--model", "moment"), "unknown model 'moment'; did you mean 'moments'?"),
        (("--warp", "bent"), "unknown warp 'bent'; use one of none, vision"),
        (("--axis", "log"), "unknown axis spacing 'log'; did you mean"),
        (("--moments", "1"), "coefficients of the moments model must be in [3, 17], got 2"),
        (("--moments", "17"), "coefficients of the moments model must be in [3, 17], got 18"),
        (("--threshold", "0"), "a threshold of 0 makes no sense; use 1e-6 to 0.1"),
        (("--threshold", "nan"), "a threshold of nan makes no sense"),
        (("--threshold", "1"), "a threshold of 1 makes no sense"),
        (("--atlas", "none.txt"), "none.txt: cannot be read: no such file"),
        (("--atlas", "empty.txt"), "empty.txt: the file is empty; name a file that holds atlas entries"),
        (("--atlas", "."), ".: cannot be read: is a directory"),
    ],
)
def test_bad_input_is_refused_before_building(refuse, monkeypatch, home, args, problem):
    monkeypatch.setattr("uplift.fit.fit_lattice", lambda *_, **__: pytest.fail("built"))
    (home / "empty.txt").write_text("")
    assert refuse("build", "--dim", "2", *args).startswith(problem)
    assert os.listdir(home) == ["empty.txt"]


def test_the_dim_proposed_is_one_that_fits(refuse):
    from uplift.pipeline.options import check_memory

    dim = int(refuse("build", "--dim", "100000").split("use dim=")[1].split()[0])
    check_memory(Options(dim=dim))
    with pytest.raises(uplift.UpliftError, match="needs about"):
        check_memory(Options(dim=dim + 1))


def test_without_a_terminal_there_is_no_progress_bar(home):
    args = uplift_process("build", *SMALL, "-o", "cube")
    done = subprocess.run(args, cwd=home, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert done.stdout.startswith("cube: 64 points")


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL there")
def test_a_killed_build_leaves_the_old_cube(home, cubes):
    path = home / "cube.uplift"
    path.write_bytes((cubes / "moments-8.uplift").read_bytes())
    before = path.read_bytes()
    args = uplift_process("build", "-v", "--dim", "48", "-o", path, "--force")
    process = subprocess.Popen(args, cwd=home, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    assert process.stderr.readline().startswith("round 0: ")
    time.sleep(0.2)
    assert process.poll() is None
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    process.stderr.close()
    assert path.read_bytes() == before
    assert uplift.load(path).data.lattice.dim == 8


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL there")
def test_a_build_killed_while_writing_leaves_the_old_cube(home, cubes):
    path = home / "cube.uplift"
    path.write_bytes((cubes / "moments-8.uplift").read_bytes())
    before = path.read_bytes()
    code = (
        "import os, signal\n"
        "from pathlib import Path\n"
        "from uplift.lookup import load\n"
        "def write_half_and_die(path, content):\n"
        "    with path.open('wb') as file:\n"
        "        file.write(content[:1000])\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
        "Path.write_bytes = write_half_and_die\n"
        "load().save('cube.uplift', force=True)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=home, capture_output=True)
    assert done.returncode == -signal.SIGKILL
    assert path.read_bytes() == before
    assert len(os.listdir(home)) == 2  # the half-written file bears another name
