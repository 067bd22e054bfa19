"""``uplift`` as a separate process."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from uplift_cli.output.streams import STAND_INS, stand_in


def test_closed_pipe_is_not_an_error():
    command = f"{sys.executable} -m uplift_cli query '#cc3319' --format json | head -c 5"
    out = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=True)
    assert out.stdout == '{"rgb'
    assert out.stderr == ""


def test_package_runs_as_a_module():
    out = subprocess.run(
        [sys.executable, "-m", "uplift_cli", "query", "0", "0", "0", "--format", "json"],
        capture_output=True,
        check=True,
    )
    assert json.loads(out.stdout)["rgb"] == [0, 0, 0]


UPLIFT = f"{sys.executable} -m uplift_cli"
COMMANDS = ("--help", "--version", "query --help", "query 0 0 0", "query 0 0 0 --format csv", "info")


def shell(command, **environment):
    """Run a command in a shell."""
    return subprocess.run(
        ["bash", "-o", "pipefail", "-c", command],
        capture_output=True,
        stdin=subprocess.DEVNULL,
        env=os.environ | environment,
        timeout=60,
    )


def error_code(done):
    """The code of a single line of JSON on standard error."""
    assert done.stderr.count(b"\n") == 1, done.stderr
    return json.loads(done.stderr)["error"]["code"]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
@pytest.mark.parametrize("command", COMMANDS)
def test_output_that_cannot_be_written_is_one_line(command):
    for place, reason in (("/dev/full", b"No space left on device"), ("&-", b"it is closed")):
        done = shell(f"{UPLIFT} {command} >{place}")
        assert done.returncode == 2
        assert done.stderr.startswith(b"error: standard output cannot be written: " + reason)
        assert done.stderr.count(b"\n") == 1


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
def test_output_that_cannot_be_written_is_json_for_json_output():
    assert error_code(shell(f"{UPLIFT} query 0 0 0 --format json >/dev/full")) == "disk-full"
    assert error_code(shell(f"{UPLIFT} query 0 0 0 --format json >&-")) == "output-closed"


@pytest.mark.parametrize("streams", ["2>&-", "2>/dev/full", "<&-"])
def test_closed_streams_that_are_not_needed_do_no_harm(streams):
    done = shell(f"{UPLIFT} query 0 0 0 --format json {streams}")
    assert done.returncode == 0
    assert json.loads(done.stdout)["rgb"] == [0, 0, 0]
    assert done.stderr == b""


def test_closed_standard_input_is_one_line():
    assert error_code(shell(f"{UPLIFT} query - --format json <&-")) == "file-unreadable"


def test_files_do_not_take_the_place_of_closed_streams(tmp_path):
    done = shell(f"cd {tmp_path} && {UPLIFT} query 0 0 0 --plot x.png <&- >&- 2>&-")
    assert done.returncode == 2  # the answer could not be printed
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "cp437", "utf-16"])
def test_terminals_without_a_character_show_a_stand_in(encoding):
    done = shell(f"{UPLIFT} query 0.2 0.3 0.4", PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    text = done.stdout.decode(encoding)
    assert "E00 " in text
    if encoding == "ascii":
        assert "of 15^3" in text
        assert "dE00 " in text
    assert "?" not in text


def test_json_is_the_same_on_any_terminal(tmp_path):
    (tmp_path / "a.csv").write_text("name,400,500,600,700\n青 ΔE00,0.1,0.2,0.3,0.4\n", encoding="utf-8")
    command = f"{UPLIFT} atlas {tmp_path}/a.csv --format json"
    answers = [shell(command, PYTHONIOENCODING=code).stdout for code in ("ascii", "latin-1", "utf-8")]
    assert [answer.isascii() for answer in answers] == [True, True, False]
    assert json.loads(answers[0]) == json.loads(answers[1]) == json.loads(answers[2])


def test_stand_ins_are_ascii_and_of_one_line():
    for character in (*STAND_INS, "é", "青", "\u2500", "\ud800"):
        text = stand_in(UnicodeEncodeError("ascii", character, 0, 1, ""))[0]
        assert text.isascii()
        assert text.isprintable()


@pytest.mark.parametrize("backend", ["nonsense", "module://nosuch", "TkAgg", ""])
def test_any_backend_of_matplotlib(tmp_path, backend):
    done = shell(f"{UPLIFT} query 0 0 0 --plot {tmp_path}/x.png", MPLBACKEND=backend)
    assert (done.returncode, done.stderr) == (0, b"")
