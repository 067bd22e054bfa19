"""Measure pages, or list them: ``python -m benchmarks [PAGE[.QUESTION] ...]``.

Each page is measured in a process with BLAS on one thread, and all pages are rendered
at the end. ``all`` answers the questions whose answers are not of the last commit of
the code, pages with the oldest first: an interrupted run continues. A question that
fails does not stop the others.
"""

import ast
import os
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks import ROOT, read_answers
from benchmarks.timing import commit_time
from uplift.extras.timing import ONE_THREAD

STALE = "stale"
"""In place of the names of questions: those whose answers are not of this commit."""
CHILD = f"""
import sys
import benchmarks

page, *names = sys.argv[1:]
if names == ["{STALE}"]:
    names = benchmarks.stale(page)
sys.exit(benchmarks.measure(page, names or benchmarks.questions(page)) > 0)
"""
UNTIMED = frozenset(
    [
        "advice",
        "cameras",
        "determinism",
        "emission",
        "fidelity",
        "install",
        "stability",
        "trust",
        "wavelengths",
    ]
)
"""Long pages without timings, which may be measured two at once."""


def pages() -> dict[str, str]:
    """Return the sentence about each module with ``QUESTIONS``, by its page."""
    lines = {}
    for path in sorted(Path(__file__).parent.glob("[!_]*.py")):
        text = path.read_text(encoding="utf-8")
        if "\nQUESTIONS" in text:
            about = ast.get_docstring(ast.parse(text)) or ""
            sentence = about.partition("\n\n")[0].replace("\n", " ")
            lines[path.stem.replace("_", "-")] = sentence
    return lines


def age(page: str) -> float:
    """Return the time of the oldest commit of a page's answers, 0 if one is unknown."""
    runs = read_answers(page).get("measured", {}).values()
    return min((commit_time(run["commit"]) for run in runs), default=0)


def run(page: str, names: Sequence[str]) -> bool:
    """Measure a page in a process, and return whether all questions were answered."""
    command = [sys.executable, "-c", CHILD, page, *names]
    variables = os.environ | ONE_THREAD
    done = subprocess.run(command, cwd=ROOT, env=variables, check=False)
    return done.returncode == 0


def run_all(jobs: dict[str, list[str]]) -> list[str]:
    """Measure pages, those without timings first and two at once, and return the pages
    that failed.
    """
    alone = [page for page in jobs if page not in UNTIMED]
    shared = [page for page in jobs if page in UNTIMED]
    with ThreadPoolExecutor(2) as pool:
        try:
            outcomes = list(pool.map(lambda page: run(page, jobs[page]), shared))
        finally:
            pool.shutdown(cancel_futures=True)
    outcomes += [run(page, jobs[page]) for page in alone]
    pairs = zip([*shared, *alone], outcomes, strict=True)
    return [page for page, answered in pairs if not answered]


def jobs_of(arguments: list[str], known: Sequence[str]) -> dict[str, list[str]]:
    """Return the questions by the pages that arguments name, none for all of a page."""
    if arguments == ["all"]:
        return {page: [STALE] for page in sorted(known, key=age)}
    jobs: dict[str, list[str]] = {}
    for argument in arguments:
        page, _, question = argument.partition(".")
        jobs.setdefault(page, []).extend([question] if question else [])
    return jobs


def main(arguments: list[str]) -> int:
    """Measure the pages and return the exit status."""
    known = pages()
    jobs = jobs_of(arguments, list(known))
    if unknown := [page for page in jobs if page not in known]:
        print(f"no page '{unknown[0]}'; pages are {', '.join(known)}", file=sys.stderr)
        return 2
    if not jobs:
        print(*(f"{name:16}{line}" for name, line in known.items()), sep="\n")
        return 0
    failed = run_all(jobs)
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    subprocess.run([sys.executable, "-m", "tools.render_docs"], cwd=ROOT, check=True)
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
