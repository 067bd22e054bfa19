"""Sizes of installations: `pip install .`, and with the extra ``plots``, by
distribution.
"""

import importlib.metadata
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks import ROOT, Row, record

WAYS = {"pip install .": ".", "pip install '.[plots]'": ".[plots]"}
OF_PIP = {"pip", "setuptools"}
"""Distributions of every environment, not counted."""


def sizes(requirement: str) -> dict[str, int]:
    """Install into an empty environment and return bytes by distribution, compiled
    modules included.
    """
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        python = Path(folder) / "bin" / "python"
        subprocess.run(
            [python, "-m", "pip", "install", "-q", requirement], cwd=ROOT, check=True
        )
        packages = next(Path(folder).glob("lib/python*/site-packages"))
        return {
            each.metadata["Name"]: sum(
                path.stat().st_size
                for path in map(Path, map(each.locate_file, each.files or []))
            )
            for each in importlib.metadata.distributions(path=[str(packages)])
            if each.metadata["Name"] not in OF_PIP
        }


def main() -> None:
    """Measure and store. Distributions that an extra adds are the difference of two
    ways.
    """
    found = {way: sizes(requirement) for way, requirement in WAYS.items()}
    ways: list[Row] = [
        {"way": way, "distributions": len(each), "megabytes": sum(each.values()) / 1e6}
        for way, each in found.items()
    ]
    everything = found["pip install '.[plots]'"]
    rows = [
        {
            "name": name,
            "megabytes": size / 1e6,
            "plots_only": name not in found["pip install ."],
        }
        for name, size in sorted(everything.items(), key=lambda item: -item[1])
        if size > 1e6
    ]
    record("install", ways=ways, distributions=rows)
