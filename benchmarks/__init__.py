"""Measurements shown in docs/, one module per page.

The ``QUESTIONS`` of a page are functions by the name that their answers have in
docs/data/PAGE.json. Answers are stored as soon as a question is done, with its time and
the commit of the code. A question that only draws returns None.
"""

import csv
import json
import sys
import traceback
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from pydantic_core import to_jsonable_python

from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.files import write_text
from uplift.common.progress import Progress
from uplift.extras.report.comparison import mean_p95_max
from uplift.extras.timing import commit, environment, stopwatch

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
DATA = ROOT / "docs" / "data"
ATLASES = ROOT / "atlases"
ATLAS_FILES = sorted(ATLASES.glob("*.txt"))
CUBES = ROOT / "cubes"
REFERENCE = ROOT / "tests" / "reference"
MACBETH = ATLASES / "macbeth.txt"
UPLIFT = str(Path(sys.executable).with_name("uplift"))
Row = dict[str, Any]
Questions = Mapping[str, Callable[[], Any]]


def questions(page: str) -> Questions:
    """Return the questions of a page."""
    module = import_module(f"{__name__}.{page.replace('-', '_')}")
    found: Questions = module.QUESTIONS
    return found


def measure(page: str, names: Iterable[str]) -> int:
    """Answer questions of a page, without the warnings of builds, and return how many
    failed, which does not stop the others.
    """
    warnings.simplefilter("ignore", UpliftWarning)
    known = questions(page)
    failures = 0
    for name in names:
        if name not in known:
            print(f"no '{name}' in {page}: {', '.join(known)}", file=sys.stderr)
            failures += 1
            continue
        try:
            answer, run = stopwatch(partial(answer_of, known[name]))
        except Exception:
            traceback.print_exc()
            print(f"{page}.{name}: failed", file=sys.stderr)
            failures += 1
        else:
            store(page, name, answer, run.wall)
            print(f"{page}.{name}: {run.wall:.1f} s", file=sys.stderr)
    return failures


def answer_of(question: Callable[[], Any]) -> Any:
    """Answer a question with values that JSON has."""
    return to_jsonable_python(question(), fallback=lambda array: array.tolist())


def stale(page: str) -> list[str]:
    """Return the questions of a page whose answers are of an older commit."""
    measured = read_answers(page).get("measured", {})
    now = commit()
    return [
        name for name in questions(page) if measured.get(name, {}).get("commit") != now
    ]


def read_answers(page: str) -> dict[str, Any]:
    """Return the stored answers of a page, with their commits and times under
    ``measured``.
    """
    path = DATA / f"{page}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def store(page: str, name: str, answer: Any, seconds: float) -> None:
    """Store the answers of a question next to those of the page's other questions."""
    answers = {**read_answers(page), name: answer}
    machine = environment()
    runs = answers.get("measured", {})
    runs[name] = {"commit": machine["commit"], "seconds": round(seconds, 1)}
    measured = {known: runs[known] for known in questions(page) if known in runs}
    commits = dict.fromkeys(run["commit"] for run in measured.values())
    content = {
        "command": f"make measure PAGE={page}",
        "environment": {**machine, "commit": ", ".join(commits)},
        "measured": measured,
    }
    for known in measured:
        if answers.get(known) is not None:
            content[known] = answers[known]
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    write_text(text + "\n", DATA / f"{page}.json", force=True)


def show(progress: Progress) -> None:
    """Print the progress of a long measurement."""
    print(f"{progress.done} of {progress.total} {progress.stage}", file=sys.stderr)


def summary(errors: Array) -> Row:
    """Return number, mean, 95 % and maximum of errors."""
    return {"n": len(errors), **mean_p95_max(errors)}


def with_printed(
    rows: Iterable[Row],
    table: str,
    keys: Sequence[str],
    **columns: Callable[[str], Any],
) -> list[Row]:
    """Add columns of a table in tests/reference, converted by functions, to the rows
    that agree with its rows in ``keys``; None to others.
    """

    def identify(row: Mapping[str, Any]) -> tuple[str, ...]:
        return tuple(str(row[key]) for key in keys)

    printed = {identify(row): row for row in read_reference(table)}
    joined = []
    for row in rows:
        same = printed.get(identify(row))
        for name, convert in columns.items():
            row = {**row, f"thesis_{name}": same and convert(same[name])}
        joined.append(row)
    return joined


def read_reference(name: str) -> list[dict[str, str]]:
    """Return the rows of a published table in tests/reference; '#' begins comments."""
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
