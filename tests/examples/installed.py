"""The package as a reader installs it: a wheel, unpacked outside the clone, and a folder with nothing else."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.conftest import ROOT

RUNNER = Path(__file__).parent / "runner.py"


def source_files(repository: Path) -> list[str]:
    """Return what git tracks, and what it would track if added; paths from the root."""
    args = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(args, cwd=repository, capture_output=True, check=True).stdout.decode()
    return [name for name in listed.split("\0") if name and (repository / name).is_file()]


def build_wheel(folder: Path) -> Path:
    """Build a wheel of a copy of the source, without leftovers of earlier builds."""
    copy = folder / "copy"
    for name in source_files(ROOT):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    args = ["-m", "build", "--wheel", "--no-isolation", "--outdir", folder / "dist", copy]
    done = subprocess.run([sys.executable, *args], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = (folder / "dist").iterdir()
    return path


def unpack(wheel: Path, folder: Path) -> Path:
    """Unpack a wheel, as an installer does."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def run_lines(lines: Sequence[str], package: Path, folder: Path) -> list[dict[str, Any]]:
    """Run command lines of the unpacked package in a folder, one after the other, and return their outcomes."""
    package = package.resolve()
    environment = os.environ | {"PYTHONPATH": str(package), "UPLIFT_FROM": str(package)}
    done = subprocess.run(
        [sys.executable, RUNNER], input=json.dumps(lines), cwd=folder, env=environment, text=True,
        stdout=subprocess.PIPE, check=True,
    )  # fmt: skip
    return list(json.loads(done.stdout))
