"""Measure pages, or list them: ``python -m benchmarks [PAGE[.QUESTION] ...]``.

Each page is measured in a process with BLAS on one thread, and all pages are rendered
at the end. ``all`` answers the questions whose answers are not of the last commit of
the code, pages with the oldest first: an interrupted run continues. A page that fails
does not stop the others.
"""

import ast
import os
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

from benchmarks import ROOT, read_answers
from uplift.lab.timing import ONE_THREAD, commit_time


def pages() -> dict[str, str]:
    """Return the sentence about each module with ``QUESTIONS``, by its page."""
    lines = {}
    for path in sorted(Path(__file__).parent.glob("[!_]*.py")):
        module = ast.parse(path.read_text(encoding="utf-8"))
        assigned = [node for node in module.body if isinstance(node, ast.Assign)]
        if "QUESTIONS" in [ast.unparse(node.targets[0]) for node in assigned]:
            about = ast.get_docstring(module) or ""
            sentence = about.partition("\n\n")[0].replace("\n", " ")
            lines[path.stem.replace("_", "-")] = sentence
    return lines


def age(page: str) -> float:
    """Return the time of the oldest commit of a page's answers, 0 if one is unknown."""
    runs = read_answers(page).get("measured", {}).values()
    return min((commit_time(run["commit"]) for run in runs), default=0)


def programs(arguments: list[str], known: list[str]) -> dict[str, str]:
    """Return the program of each page that arguments name."""
    if arguments == ["all"]:
        return {page: f"measure_stale('{page}')" for page in sorted(known, key=age)}
    asked: dict[str, list[str]] = defaultdict(list)
    for argument in arguments:
        page, _, question = argument.partition(".")
        asked[page] += [question] if question else []
    return {page: f"measure('{page}', {names})" for page, names in asked.items()}


def main(arguments: list[str]) -> int:
    """Measure the pages and return the exit status."""
    known = pages()
    if not arguments:
        print(*(f"{name:16}{line}" for name, line in known.items()), sep="\n")
        return 0
    asked = programs(arguments, list(known))
    if unknown := [page for page in asked if page not in known]:
        print(f"no page '{unknown[0]}'; pages are {', '.join(known)}", file=sys.stderr)
        return 2
    failed = []
    for page, program in asked.items():
        print(page, file=sys.stderr)
        command = [
            sys.executable,
            "-c",
            f"from benchmarks import measure, measure_stale; {program}",
        ]
        variables = os.environ | ONE_THREAD
        if subprocess.run(command, cwd=ROOT, env=variables, check=False).returncode:
            failed.append(page)
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    subprocess.run([sys.executable, "-m", "tools.render_docs"], cwd=ROOT, check=True)
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
