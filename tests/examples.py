"""Every ``uplift`` line of the README, the documentation and the help texts, run where
a reader would run it.

``python -m tests.examples [PAGE...]`` (``make examples``) runs them from a wheel,
unpacked outside the clone, each page in a new folder with the sample files, and exits
with 1 if one fails; ``tests/test_package.py`` runs a few.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from uplift_cli.main import main

from tests.cli.conftest import commands

ROOT = Path(__file__).parents[1]
BLOCKS = re.compile(r"^```(\S*)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
SHELLS = ("", "console", "bash", "sh")
CUBE = "uplift build --atlas macbeth --dim 32"
"""Command of the cube that help texts use. A page of the documentation that uses it has
this line.
"""
TUTORIAL = "docs/tutorial.md"
"""The page whose commands and Python tests/test_docs.py runs together, in a separate
folder.
"""
ELSEWHERE = {
    (
        "uplift texture 'shot.*.exr' -o many --cube macbeth-32.uplift --scheduler "
        "tcp://10.0.0.5:8786"
    ),
    "uplift texture 'shot.*.exr' -o spectra --scheduler tcp://10.0.0.5:8786",
    "uplift texture shot.*.exr -o uplifted --scheduler tcp://10.0.0.5:8786",
}
"""Examples that need a Dask cluster at that address."""


def examples() -> list[str]:
    """Return every example once."""
    return list(dict.fromkeys(chain.from_iterable(examples_by_page().values())))


def examples_by_page() -> dict[str, list[str]]:
    """Return the examples of each page of the documentation and of each help text, in
    reading order.
    """
    paths = [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))]
    texts = {
        path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths
    }
    del texts[TUTORIAL]
    listed = {name: page_examples(text) for name, text in texts.items()}
    listed |= help_examples()
    return {name: lines for name, lines in listed.items() if lines}


def page_examples(text: str) -> list[str]:
    """Return the examples of a page: lines that begin with ``uplift``, ``mkdir -p`` or
    ``cd`` in its code blocks.
    """
    lines = []
    for language, block in BLOCKS.findall(text):
        if language not in SHELLS:
            continue
        for line in block.replace("\\\n", " ").splitlines():
            if match := re.match(r"(?:\$ )?((?:uplift|mkdir -p|cd) .*)", line):
                lines.append(" ".join(match[1].partition("    #")[0].split()))
    return lines


def help_examples() -> dict[str, list[str]]:
    """Return the examples of the help of every command, with those of its subcommands,
    once each. Commands of the laboratory are listed apart.
    """
    listed: dict[str, list[str]] = {}
    for path, command in commands(main).items():
        words = path.split()
        name = " ".join(words[:2] if words[0] == "lab" else words[:1])
        found = re.findall(r"^ *(uplift .*?) *$", command.help or "", re.MULTILINE)
        lines = listed.setdefault(f"{name} --help", [])
        lines += [line for line in dict.fromkeys(found) if line not in lines]
    return listed


def source_files(repository: Path) -> list[str]:
    """Return what git tracks, and what it would track if added; paths from the root."""
    args = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(
        args, cwd=repository, capture_output=True, check=True
    ).stdout.decode()
    return [
        name for name in listed.split("\0") if name and (repository / name).is_file()
    ]


def build_distributions(folder: Path) -> Path:
    """Build a source distribution, and a wheel of it, of a copy of the source without
    leftovers of earlier builds; return their folder.
    """
    copy = folder / "copy"
    for name in source_files(ROOT):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    args = ["-m", "build", "--no-isolation", "--outdir", "dist", copy]
    done = subprocess.run(
        [sys.executable, *args], cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "dist"


def build_wheel(folder: Path) -> Path:
    """Build a wheel as `build_distributions`, and return its path."""
    (wheel,) = build_distributions(folder).glob("*.whl")
    return wheel


def unpack(wheel: Path, folder: Path) -> Path:
    """Unpack a wheel, as an installer does."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def run_lines(
    lines: Sequence[str], package: Path, folder: Path
) -> list[dict[str, Any]]:
    """Run command lines of the unpacked package in a folder, one after the other, and
    return their outcomes.
    """
    package = package.resolve()
    environment = os.environ | {"PYTHONPATH": str(package), "UPLIFT_FROM": str(package)}
    command = [sys.executable, Path(__file__).parent / "run_lines.py"]
    done = subprocess.run(
        command,
        input=json.dumps(lines),
        cwd=folder,
        env=environment,
        text=True,
        stdout=subprocess.PIPE,
        check=True,
    )
    return list(json.loads(done.stdout))


def run_all(names: Sequence[str]) -> int:
    """Run the examples of pages, all by default, each page in its folder, and print
    those that fail.
    """
    listed = examples_by_page()
    if names:
        listed = {name: listed[name] for name in names}
    with tempfile.TemporaryDirectory() as temporary:
        root = Path(temporary)
        package = unpack(build_wheel(root), root / "package")
        run_lines(["uplift samples"], package, root)
        samples = root / "uplift-samples"
        run_lines([CUBE], package, root)
        count = 0
        failures = 0
        for number, (name, lines) in enumerate(listed.items()):
            print(f"{name}:", file=sys.stderr, flush=True)
            folder = shutil.copytree(samples, root / str(number))
            if name.endswith("--help") and CUBE not in lines:
                shutil.copy(root / "macbeth-32.uplift", folder)
            runnable = [line for line in lines if line not in ELSEWHERE]
            outcomes = run_lines(runnable, package, folder)
            failed = [outcome for outcome in outcomes if outcome["code"]]
            for outcome in failed:
                print(f"{name}: {outcome['line']}\n{outcome['stderr']}")
            count += len(outcomes)
            failures += len(failed)
    print(f"{count - failures} of {count} examples run")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(run_all(sys.argv[1:]))
