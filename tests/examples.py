"""Every ``uplift`` line of the README, the documentation and the help texts, run where a reader would run it.

``python -m tests.examples`` (``make examples``) runs all of them from a wheel, unpacked outside the clone, in an empty
folder, and exits with 1 if one fails; ``tests/test_package.py`` runs a few.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import click
from uplift_cli.main import COMMANDS, main

ROOT = Path(__file__).parents[1]
BLOCKS = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
SHELLS = ("", "console", "bash", "sh")
FIRST = ("README.md", "docs/commands.md")
"""Pages that are read first. The others are in alphabetical order, after the help texts."""
TUTORIAL = "docs/tutorial.md"
"""The page whose commands and Python tests/test_docs.py runs together, in a separate folder."""
ELSEWHERE = {
    "uplift texture 'shot.*.exr' -o sequence --cube macbeth-32.uplift --scheduler tcp://10.0.0.5:8786",
    "uplift texture 'shot.*.exr' -o uplifted --scheduler tcp://10.0.0.5:8786",
    "uplift texture shot.*.exr -o uplifted --scheduler tcp://10.0.0.5:8786",
}
"""Examples that need a Dask cluster at that address."""


def examples() -> list[str]:
    """Return every example once, in reading order."""
    pages = {path.relative_to(ROOT).as_posix(): path for path in ROOT.glob("docs/**/*.md")}
    del pages[TUTORIAL]
    first = [ROOT / "README.md", pages.pop(FIRST[1])]
    texts = [page_examples(path.read_text(encoding="utf-8")) for path in (*first, *map(pages.get, sorted(pages)))]
    texts.insert(len(FIRST), help_examples())
    return list(dict.fromkeys(line for each in texts for line in each))


def page_examples(text: str) -> Iterator[str]:
    """Yield the examples of a page: lines that begin with ``uplift`` or ``mkdir -p`` in its code blocks."""
    for language, block in BLOCKS.findall(text):
        for line in block.replace("\\\n", " ").splitlines() if language in SHELLS else ():
            if match := re.match(r"(?:\$ )?((?:uplift|mkdir -p|cd) .*)", line):
                yield " ".join(match[1].partition("    #")[0].split())


def help_examples() -> Iterator[str]:
    """Yield the examples of the help of every command and subcommand."""
    with click.Context(main, **main.context_settings) as context:
        for name in COMMANDS:
            command = main.get_command(context, name)
            assert command is not None
            for each in (command, *getattr(command, "commands", {}).values()):
                lines = (line.strip() for line in (each.help or "").splitlines())
                yield from (line for line in lines if line.startswith("uplift "))


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
    command = [sys.executable, Path(__file__).parent / "run_lines.py"]
    options = {"cwd": folder, "env": environment, "text": True, "stdout": subprocess.PIPE, "check": True}
    return list(json.loads(subprocess.run(command, input=json.dumps(lines), **options).stdout))


def run_all() -> int:
    """Run the examples in an empty folder and print those that fail."""
    lines = [line for line in examples() if line not in ELSEWHERE]
    with tempfile.TemporaryDirectory() as name:
        folder, package = Path(name) / "empty", Path(name) / "package"
        folder.mkdir()
        outcomes = run_lines(lines, unpack(build_wheel(Path(name)), package), folder)
    failures = [outcome for outcome in outcomes if outcome["code"]]
    for outcome in failures:
        print(f"{outcome['line']}\n{outcome['stderr']}")
    print(f"{len(outcomes) - len(failures)} of {len(outcomes)} examples run")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(run_all())
