"""Sizes of installations: `pip install .`, and with the extra ``plots``, by
distribution.
"""

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from importlib.metadata import Distribution, distributions
from pathlib import Path

from benchmarks import ROOT, Row

WAYS = {".": "pip install .", ".[plots]": "pip install '.[plots]'"}
OF_PIP = {"pip", "setuptools"}
"""Distributions of every environment, not counted."""


def megabytes(distribution: Distribution) -> float:
    """Return the size of the files of a distribution, with compiled modules."""
    files = distribution.files or []
    paths = [Path(distribution.locate_file(file)) for file in files]
    return sum(path.stat().st_size for path in paths) / 1e6


def sizes() -> Iterator[Row]:
    """Yield the distributions that each way installs into an empty environment."""
    for requirement, way in WAYS.items():
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-m", "venv", folder], check=True)
            pip = [f"{folder}/bin/python", "-m", "pip", "install", "-q"]
            subprocess.run([*pip, requirement], cwd=ROOT, check=True)
            packages = [str(path) for path in Path(folder).glob("lib/*/site-packages")]
            for each in distributions(path=packages):
                name = each.metadata["Name"]
                if name not in OF_PIP:
                    yield {"way": way, "name": name, "megabytes": megabytes(each)}


QUESTIONS = {"sizes": sizes}
