"""Measure pages, or list them: ``python -m benchmarks [PAGE ...]``.

Each page is measured in a process with BLAS on one thread, and all pages are rendered
at the end. ``all`` names the pages whose figures are not of the last commit of the
code, so that an interrupted run continues. A page that fails does not stop the others.
"""

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

from benchmarks import DATA, ROOT
from uplift.lab.timing import ONE_THREAD, commit


def pages() -> dict[str, str]:
    """Return the first line about each module with a function ``main``, by its page."""
    lines = {}
    for path in sorted(Path(__file__).parent.glob("[!_]*.py")):
        module = ast.parse(path.read_text(encoding="utf-8"))
        functions = [node for node in module.body if isinstance(node, ast.FunctionDef)]
        if "main" in [function.name for function in functions]:
            about = ast.get_docstring(module) or ""
            lines[path.stem.replace("_", "-")] = about.partition("\n")[0]
    return lines


def is_current(page: str) -> bool:
    """Whether the figures of a page were measured at the last commit of the code."""
    data = DATA / f"{page}.json"
    stored = json.loads(data.read_text(encoding="utf-8")) if data.is_file() else {}
    return bool(stored.get("environment", {}).get("commit") == commit())


def main(names: list[str]) -> int:
    """Measure the pages and return the exit status."""
    known = pages()
    if not names:
        print(*(f"{name:16}{line}" for name, line in known.items()), sep="\n")
        return 0
    if names == ["all"]:
        names = [name for name in known if not is_current(name)]
    if unknown := [name for name in names if name not in known]:
        print(f"no page '{unknown[0]}'; pages are {', '.join(known)}", file=sys.stderr)
        return 2
    failed = []
    for name in names:
        print(name, file=sys.stderr)
        program = f"from benchmarks import measure; measure('{name}')"
        command = [sys.executable, "-c", program]
        variables = os.environ | ONE_THREAD
        if subprocess.run(command, cwd=ROOT, env=variables, check=False).returncode:
            failed.append(name)
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    subprocess.run([sys.executable, "-m", "tools.render_docs"], cwd=ROOT, check=True)
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
