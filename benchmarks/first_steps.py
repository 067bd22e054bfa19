"""From nothing to the first relit picture, with three commands in a new environment: ``make first-steps``.

Writes docs/data/first-steps.json: CPU and wall-clock seconds of each command. Nothing is cached, so the wall-clock
time has the downloads, which depend on the network.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from benchmarks.record import write
from tests.examples.installed import copy_source

COMMANDS = ("python3 -m venv env", "env/bin/pip install ./uplift", "env/bin/uplift relight")


def main() -> None:
    """Run the commands in an empty folder next to a copy of the source, and store their times."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_source(folder / "uplift")
        steps = [run(command, folder) for command in COMMANDS]
        assert (folder / "relit.png").is_file()
    write(
        "first-steps",
        "make first-steps",
        steps=steps,
        cpu=sum(step["cpu"] for step in steps),
        wall=sum(step["wall"] for step in steps),
    )
    print(*steps, sep="\n", file=sys.stderr)


def run(command: str, folder: Path) -> dict[str, Any]:
    """Run a command and return its CPU and wall-clock seconds."""
    words = [sys.executable if word == "python3" else word for word in command.split()]
    begin, before = time.perf_counter(), _cpu()
    subprocess.run(
        words,
        cwd=folder,
        check=True,
        stdout=subprocess.DEVNULL,
        env=os.environ | {"XDG_CACHE_HOME": str(folder)},
    )
    return {"command": command, "cpu": _cpu() - before, "wall": time.perf_counter() - begin}


def _cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    main()
