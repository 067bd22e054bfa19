"""Places and names that a command meets: folders that are gone or closed, users without a home, odd file names."""

from __future__ import annotations

import os
import shutil
import subprocess

import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from .test_process import UPLIFT, shell

NAMES = {"not UTF-8": os.fsdecode(b"\xff\xfe"), "255 bytes": "x" * 248, "a newline": "a\nb\x1b[2J"}
USER = 12345
"""A user without an entry in the table of users."""
AS_NOBODY = f"unshare -U --map-user={USER} --map-group={USER} env -u HOME -u XDG_CACHE_HOME"
can_change_user = not os.getuid() and not subprocess.run([*AS_NOBODY.split(), "true"], capture_output=True).returncode


def lines(done):
    """Lines of standard error, which are printable and have no traceback."""
    text = done.stderr.decode()
    assert all(line.isprintable() for line in text.splitlines())
    assert "internal error" not in text
    assert "Traceback" not in text
    return text.splitlines()


@pytest.mark.parametrize(
    "arguments", ["query 0 0 0 --format json", "--version", "atlas macbeth", "query 0 0 0 --plot x.png"]
)
def test_deleted_working_folder(tmp_path, arguments):
    done = shell(f"mkdir {tmp_path}/gone && cd {tmp_path}/gone && rmdir ../gone && {UPLIFT} {arguments}")
    assert (done.returncode, len(lines(done))) == ((2, 1) if "--plot" in arguments else (0, 0))


@pytest.mark.skipif(not can_change_user, reason="needs user namespaces")
def test_user_without_home_and_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert not lines(shell(f"{AS_NOBODY} {UPLIFT} query 0 0 0 --plot {tmp_path}/x.png", JAX_COMPILATION_CACHE_DIR=""))
    assert os.listdir(tmp_path) == ["x.png"]


@pytest.mark.skipif(not can_change_user, reason="needs user namespaces")
@pytest.mark.parametrize(
    "arguments",
    [
        "info shut/c",
        "query --cube shut/c 0 0 0",
        "query 0 0 0 --plot shut/x.png",
        "atlas shut/a",
        "query --input shut/a",
    ],
)
def test_folder_that_may_not_be_searched(tmp_path, cubes, arguments):
    shut = tmp_path / "shut"
    shut.mkdir()
    shutil.copy(cubes / "moments-8.uplift", shut / "c")
    shut.chmod(0)
    done = shell(f"cd {tmp_path} && {AS_NOBODY} {UPLIFT} {arguments}")
    shut.chmod(0o755)
    (line,) = lines(done)
    assert done.returncode == 2
    assert "permission" in line.lower()


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize(
    "arguments",
    ["info {}.uplift", "info {}.uplift --format json", "atlas {}.txt", "query 0 0 0 --plot {}.png", "info {}-.uplift",
     "export {}.uplift -o {}.csv", "query 0 0 0 --cube {}.uplift --format csv", "slices {}.uplift --plot {}.sh.png",
     "report {}.uplift -o {}.htm", "texture {}.png -o t.exr", "query {}", "query --{}", "{}"],
)  # fmt: skip
def test_names_of_files(home, cubes, macbeth, name, arguments):
    shutil.copy(cubes / "moments-8.uplift", f"{name}.uplift")
    shutil.copy(macbeth, f"{name}.txt")
    result = CliRunner().invoke(main, [word.replace("{}", name) for word in arguments.split()])
    assert result.exit_code in (0, 2), result.exception
    errors = [line for line in result.stderr.splitlines() if not line.startswith("warning: ")]
    assert len(errors) == (result.exit_code != 0)
    assert all(line.isprintable() for line in result.output.splitlines())
