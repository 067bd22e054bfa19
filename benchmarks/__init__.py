"""Measurements shown in docs/, one file per page: ``make measure PAGE=name`` runs one
and renders the pages.
"""

import csv
import sys
import warnings
from importlib import import_module
from pathlib import Path
from typing import Any

from uplift.common.errors import UpliftWarning
from uplift.common.progress import Progress
from uplift.lab.timing import write_record

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
DATA = ROOT / "docs" / "data"
ATLASES = ROOT / "atlases"
ATLAS_FILES = sorted(ATLASES.glob("*.txt"))
CUBES = ROOT / "cubes"
REFERENCE = ROOT / "tests" / "reference"
MACBETH = ATLASES / "macbeth.txt"
Row = dict[str, Any]


def measure(page: str) -> None:
    """Run the program of a page, without the warnings of builds."""
    warnings.simplefilter("ignore", UpliftWarning)
    import_module(f"{__name__}.{page.replace('-', '_')}").main()


def record(page: str, data: str = "", **figures: Any) -> None:
    """Write figures to docs/data/PAGE.json, or to DATA.json if the page has several."""
    write_record(DATA / f"{data or page}.json", f"make measure PAGE={page}", **figures)


def show(progress: Progress) -> None:
    """Print the progress of a long measurement."""
    print(f"{progress.done} of {progress.total} {progress.stage}", file=sys.stderr)


def read_reference(name: str) -> list[dict[str, str]]:
    """Return the rows of a published table in tests/reference; '#' begins comments."""
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
