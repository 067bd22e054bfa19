"""``uplift build``."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from uplift_cli.output.hints import hint_for

import uplift
from tests.helpers import raises
from uplift.pipeline.options import Options

from .conftest import warning_lines

SMALL = ("--dim", "4", "--coefficients", "4")


def uplift_process(*args):
    code = "from uplift_cli.main import main; main()"
    return [sys.executable, "-c", code, *map(str, args)]


def test_cube_is_written_and_summarised_on_one_line(run, home):
    result = run("build", *SMALL, "-o", "cube.uplift")
    assert os.listdir(home) == ["cube.uplift"]
    data = uplift.load(home / "cube.uplift").data
    assert (data.lattice.dim, data.model.count, data.points.round) == (4, 4, None)
    assert result.stdout.startswith("cube.uplift: 64 nodes, all within 0.0001 (worst ")
    assert result.stdout.count("\n") == 1
    assert result.stderr == ""


def test_help_has_the_default_lights(run):
    assert f"[default: {' '.join(Options.lights)}]" in " ".join(run("build", "--help").stdout.split())


def test_unrealisable_colours_are_counted(run, home):
    result = run("build", "--dim", "3", "--space", "ITU-R BT.2020", "-o", "wide.uplift")
    count = uplift.load(home / "wide.uplift").data.points.counts()["unrealisable"]
    assert count > 0
    assert f"{count} unrealisable" in result.stdout
    query = ("query", "--cube", "wide.uplift")
    assert "\nrealisable  no" in run(*query, "0", "1", "0").stdout
    assert "\nrealisable" not in run(*query, "0.5", "0.5", "0.5").stdout


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
def test_default_name_has_atlas_or_space_and_dim(run, home, args, name):
    (home / "far").mkdir()
    (home / "a.csv").write_text("name,380,780\ngrey,0.5,0.5\n")
    (home / "far" / "b.csv").write_text("name,380,780\nblack,0.01,0.01\n")
    run("build", "--dim", "2", "--coefficients", "4", *args)
    assert {path.name for path in home.iterdir()} - {"a.csv", "far"} == {name}


def test_all_options_are_passed_to_the_build(run, home):
    run("build", "--dim", "3", "--coefficients", "5", "--warp", "vision", "--axis", "linear", "--space", "Display P3",
        "--illuminant", "D50", "--observer", "CIE 1964 10 Degree Standard Observer", "--light", "A",
        "--light", "FL2", "--start", "neighbours",
        "--solver", "dogleg", "--threshold", "1e-3", "--debug", "-o", "cube")  # fmt: skip
    data = uplift.load(home / "cube").data
    assert data.model == uplift.models.Moments(5, uplift.models.Phase(warp="vision"))
    np.testing.assert_array_equal(data.lattice.nodes, [0, 0.5, 1])
    assert (data.sensor.space, data.sensor.illuminant) == ("Display P3", "D50")
    assert data.sensor.observer == "CIE 1964 10 Degree Standard Observer"
    assert data.threshold == 1e-3
    assert data.points.round is not None
    assert data.provenance["options"]["lights"] == ["A", "FL2"]
    assert data.provenance["options"]["start"] == "neighbours"
    assert data.provenance["options"]["solver"] == "dogleg"


def test_range_and_step(run, home):
    run("build", "--dim", "2", "--coefficients", "4", "--range", "360:830", "--step", "10", "-o", "cube")
    data = uplift.load(home / "cube").data
    assert data.sensor.range == (360, 830, 10)
    assert (data.model.phase.start, data.model.phase.end) == (360, 830)
    run("check", "cube")


def test_sigmoid_model(run, home):
    run("build", "--dim", "3", "--model", "sigmoid", "-o", "cube")
    assert uplift.load(home / "cube").data.model.name == "sigmoid"


def test_the_same_input_gives_the_same_bytes(run, home, macbeth):
    for name in ("a", "b"):
        run("build", "--atlas", macbeth, *SMALL, "-o", name)
    assert (home / "a").read_bytes() == (home / "b").read_bytes()


def test_entries_out_of_gamut_are_left_out_with_a_warning(run, macbeth):
    result = run("build", "--atlas", macbeth, *SMALL, "-o", "cube")
    warnings = warning_lines(result)
    assert "'cyan'" in warnings[0]
    assert "(-0.0334, 0.2488, 0.3855)" in warnings[0]
    assert len(warnings) == result.stderr.count("\n")
    assert "23 atlas entries" in result.stdout


def test_quiet_prints_only_warnings(run, macbeth):
    result = run("build", "-q", *SMALL, "-o", "plain")
    assert (result.stdout, result.stderr) == ("", "")
    result = run("build", "-q", "--atlas", macbeth, *SMALL, "-o", "cube")
    assert result.stdout == ""
    warnings = warning_lines(result)
    assert "'cyan'" in warnings[0]
    assert len(warnings) == result.stderr.count("\n")


def test_verbose_prints_every_round_and_storing(run):
    result = run("build", "-v", *SMALL, "-o", "cube")
    rounds = [line for line in result.stderr.splitlines() if line.startswith("fitting: ")]
    counts = [int(re.match(r"fitting: (\d+) of 64", line)[1]) for line in rounds]
    assert counts == sorted(counts)
    assert counts[-1] == 64
    assert "\nstoring: 64 of 64" in result.stderr
    assert "\x1b" not in result.stderr
    assert "\r" not in result.stderr


def test_files_are_replaced_only_with_force(run, refuse, home):
    (home / "cube").write_text("mine")
    error = refuse("build", *SMALL, "-o", "cube")
    assert (error.code, error.where) == ("file-exists", "cube")
    assert "--force" in hint_for(error)
    assert (home / "cube").read_text() == "mine"
    run("build", *SMALL, "-o", "cube", "--force")
    assert uplift.load(home / "cube").data.lattice.dim == 4


@pytest.mark.parametrize(
    ("args", "code"),
    [
        (("-o", "none/cube"), "output"),
        (("-o", "."), "not-a-regular-file"),
        (("-o", ""), "not-a-regular-file"),
        (("-o", "x" * 300), "output"),
        (("--dim", "1"), "dim-too-small"),
        (("--dim", "0"), "dim-too-small"),
        (("--dim", "-3"), "dim-too-small"),
        (("--dim", "100000"), "option"),
        (("--dim", "1000000000000"), "option"),
        (("--illuminant", "D66"), "unknown-illuminant"),
        (("--space", "sRGBB"), "unknown-rgb-space"),
        (("--space", "no/where"), "unknown-rgb-space"),
        (("--observer", "CIE 1931"), "unknown-observer"),
        (("--light", "FL99"), "unknown-illuminant"),
        (("--model", "moment"), "unknown-model"),
        (("--warp", "bent"), "unknown-warp"),
        (("--axis", "log"), "unknown-axis-spacing"),
        (("--start", "seeds"), "unknown-start"),
        (("--solver", "newton"), "unknown-solver"),
        (("--range", "360"), "option"),
        (("--range", "360:830:5"), "option"),
        (("--range", "830:360"), "option"),
        (("--range", "360:1100"), "option"),
        (("--range", "361:830"), "range-not-in-steps"),
        (("--step", "3"), "unsupported-step"),
        (("--coefficients", "2"), "coefficients-out-of-range"),
        (("--coefficients", "18"), "coefficients-out-of-range"),
        (("--entry-coefficients", "18"), "entry-coefficients-out-of-range"),
        (("--threshold", "0"), "threshold-out-of-range"),
        (("--threshold", "0.2"), "threshold-out-of-range"),
        (("--threshold", "1"), "threshold-out-of-range"),
        (("--atlas", "none.txt"), "file-not-found"),
        (("--atlas", "empty.txt"), "atlas"),
        (("--atlas", "."), "not-a-regular-file"),
    ],
)
def test_invalid_input_is_reported_before_the_build(refuse, monkeypatch, home, args, code):
    monkeypatch.setattr("uplift.pipeline.build.grow_from_prior", lambda *_, **__: pytest.fail("built"))
    (home / "empty.txt").write_text("")
    assert refuse("build", "--dim", "2", *args).code == code
    assert os.listdir(home) == ["empty.txt"]


def test_suggested_dim_fits_into_memory(refuse):
    from uplift.pipeline.options import check_memory

    error = refuse("build", "--dim", "100000")
    dim = int(re.search(r"\d+", error.hint)[0])
    check_memory(Options(dim=dim))
    with raises(uplift.OptionError, "option"):
        check_memory(Options(dim=dim + 1))


def test_entries_have_the_given_number_of_coefficients(run, home):
    for name, *options in (("a", "--entry-coefficients", 12), ("b",)):
        run("build", "--atlas", "macbeth", "--dim", 2, "--coefficients", 4, *options, "-o", name)
    counts = {name: uplift.load(home / name).entry_coefficient_count for name in "ab"}
    assert counts == {"a": 12, "b": 17}


def test_progress_bars_need_a_terminal(home):
    args = uplift_process("build", *SMALL, "-o", "cube")
    done = subprocess.run(args, cwd=home, capture_output=True, text=True, check=True)
    assert "\x1b" not in done.stderr
    assert all(re.fullmatch(r"[a-z ]+: \d+ of \d+.*", line) for line in done.stderr.splitlines())
    assert done.stdout.startswith("cube: 64 nodes")


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL there")
def test_killed_builds_leave_the_old_cube(home, cubes):
    path = home / "cube.uplift"
    path.write_bytes((cubes / "moments-8.uplift").read_bytes())
    before = path.read_bytes()
    args = uplift_process("build", "-v", "--dim", "48", "-o", path, "--force")
    process = subprocess.Popen(args, cwd=home, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    assert process.stderr.readline().startswith("fitting: ")
    time.sleep(0.2)
    assert process.poll() is None
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    process.stderr.close()
    assert path.read_bytes() == before
    assert uplift.load(path).data.lattice.dim == 8


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL there")
def test_builds_killed_while_writing_leave_the_old_cube(home, cubes):
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
    assert len(os.listdir(home)) == 2  # the incomplete file has another name


def test_looks_are_built_summarised_and_shown(run, home):
    (home / "looks.toml").write_text('[[look]]\nrgb = "#8a2a20"\nHP1 = "#70392a"\nname = "brick"\n')
    result = run("build", *SMALL, "--prior", "smooth", "--look", "looks.toml", "-o", "looks.uplift")
    assert ", 1 look, " in result.stdout
    assert result.stderr == ""
    line = next(line for line in run("info", "looks.uplift").stdout.splitlines() if line.startswith("look brick"))
    assert line.split()[2:] == ["HP1", "#70392a", "(ΔE00", "0.00)"]
    assert run("check", "looks.uplift", "--format", "json").exit_code == 0


def test_impossible_look_is_a_warning(run, home):
    (home / "looks.toml").write_text('[[look]]\nrgb = "#4060a0"\nA = "#5060a0"\n')
    result = run("build", *SMALL, "--prior", "smooth", "--look", "looks.toml", "-o", "looks.uplift")
    (line,) = warning_lines(result)
    assert "looks.toml:1" in line
    assert "#5060a0" in line


def test_looks_are_not_overwritten(run, home):
    (home / "looks.toml").write_text('[[look]]\nrgb = "#4060a0"\nA = "#5060a0"\n')
    result = run("build", *SMALL, "--look", "looks.toml", "-o", "looks.toml", "--force", code=2)
    assert "looks.toml" in result.stderr
