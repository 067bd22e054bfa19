"""Programs that tests compile, kept between runs by all that they are made of."""

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

from tests.conftest import CACHE

SOURCES = (".c", ".cuh", ".h")
ORIGIN = re.compile(rb"Written by uplift .*")
"""Comment with the version and the cube, in which equal programs differ."""


def compile_in(
    folder: Path, compiler: str, *options: str, output: str = "main"
) -> Path:
    """Compile ``main.c`` of a folder with the sources next to it, unless an equal
    program is kept. Raises `subprocess.CalledProcessError`.
    """
    kept = CACHE / "programs" / _digest(folder, compiler, options)
    path = folder / output
    if not kept.exists():
        libraries = [] if "-c" in options else ["-lm"]
        command = [compiler, *options, "main.c", "-o", output, *libraries]
        subprocess.run(command, cwd=folder, check=True)
        _keep(path, kept)
    shutil.copy(kept, path)
    return path


def _digest(folder: Path, compiler: str, options: tuple[str, ...]) -> str:
    digest = hashlib.sha256(repr((_version(compiler), options)).encode())
    for source in sorted(folder.iterdir()):
        if source.suffix in SOURCES:
            text = ORIGIN.sub(b"", source.read_bytes())
            digest.update(repr((source.name, text)).encode())
    return digest.hexdigest()


@cache
def _version(compiler: str) -> bytes:
    return subprocess.run([compiler, "--version"], capture_output=True).stdout


def _keep(path: Path, kept: Path) -> None:
    """Other workers see a whole file, or none."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=kept.parent) as folder:
        os.replace(shutil.copy(path, folder), kept)
