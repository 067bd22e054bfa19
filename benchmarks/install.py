"""Sizes of installations: `pip install .`, and with the extra ``plots``, by
distribution.
"""

import importlib.metadata
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks import ROOT, record

OF_PIP = {"pip", "setuptools"}
"""Distributions of every environment, not counted."""


def sizes(requirement: str) -> dict[str, int]:
    """Install into an empty environment; return bytes by distribution, with compiled
    modules.
    """
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        python = Path(folder) / "bin" / "python"
        subprocess.run(
            [python, "-m", "pip", "install", "-q", requirement], cwd=ROOT, check=True
        )
        packages = next(Path(folder).glob("lib/python*/site-packages"))
        bytes_of = {}
        for distribution in importlib.metadata.distributions(path=[str(packages)]):
            paths = map(Path, map(distribution.locate_file, distribution.files or []))
            size = sum(path.stat().st_size for path in paths)
            bytes_of[distribution.metadata["Name"]] = size
        return {name: size for name, size in bytes_of.items() if name not in OF_PIP}


def main() -> None:
    """Measure and store."""
    plain = sizes(".")
    plots = sizes(".[plots]")
    rows = [
        {"name": name, "megabytes": size / 1e6, "plots_only": name not in plain}
        for name, size in sorted(plots.items(), key=lambda item: -item[1])
        if size > 1e6
    ]
    ways = [
        {
            "way": way,
            "distributions": len(listed),
            "megabytes": sum(listed.values()) / 1e6,
        }
        for way, listed in (("pip install .", plain), ("pip install '.[plots]'", plots))
    ]
    record("install", ways=ways, distributions=rows)
