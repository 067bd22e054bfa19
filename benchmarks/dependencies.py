"""Installed size and import time of the run-time dependencies, and who uses them: ``make dependencies``."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from benchmarks.record import ROOT, write
from uplift.lab.timing import Spread, spread

RUNS = 5
FOLDERS = {"uplift": "uplift", "cli": "uplift_cli"}
"""Folders of the source, and the packages that they are installed as."""
MODULES = {
    "colour-cxf": "colour_cxf",
    "colour-science": "colour",
    "opencolorio": "PyOpenColorIO",
    "pillow": "PIL",
    "python-calamine": "python_calamine",
}
"""Modules whose name differs from that of the distribution."""
EXTRAS = ("cluster", "io", "mitsuba")
"""Extras of users; the others are for development."""


@dataclass(frozen=True)
class Dependency:
    """Cost of a dependency.

    ``size`` counts the bytes of the files of the distribution, ``saved`` those of all distributions that would not be
    installed without it. ``seconds`` is the time to import the modules that the source uses, in a new process.
    ``used_by`` are the packages that import it, ``extra`` is empty for a required dependency.
    """

    name: str
    version: str
    extra: str
    size: int
    saved: int
    seconds: Spread
    used_by: list[str]


def requirements() -> dict[str, str]:
    """Return the extra of each run-time dependency of pyproject.toml, empty for required ones."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    groups = {"": project["dependencies"]} | {extra: project["optional-dependencies"][extra] for extra in EXTRAS}
    return {Requirement(text).name: extra for extra, texts in groups.items() for text in texts}


def imports(module: str) -> dict[str, set[str]]:
    """Return the import statements of a module in the source, by package that contains them."""
    found: dict[str, set[str]] = {}
    for package, imported, statement in _source_imports():
        if imported == module:
            found.setdefault(package, set()).add(statement)
    return found


@cache
def _source_imports() -> list[tuple[str, str, str]]:
    """Importing package, imported module and statement of every import in the source."""
    return [
        (".".join((package, *path.parent.relative_to(ROOT / folder).parts)), module, statement)
        for folder, package in FOLDERS.items()
        for path in (ROOT / folder).rglob("*.py")
        for module, statement in import_statements(ast.parse(path.read_text(encoding="utf-8")))
    ]


def import_statements(node: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield the top-level module and the statement of imports below a node, without those for type checkers."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        names = [child.module or ""] if isinstance(child, ast.ImportFrom) and child.level == 0 else []
        names = [alias.name for alias in child.names] if isinstance(child, ast.Import) else names
        for module in dict.fromkeys(name.split(".")[0] for name in names):
            yield module, ast.unparse(child)
        yield from import_statements(child)


def installed(names: Iterable[str]) -> set[str]:
    """Return the canonical names of distributions and of everything that they require here."""
    found: set[str] = set()
    open_names = [(canonicalize_name(name), frozenset[str]()) for name in names]
    while open_names:
        name, extras = open_names.pop()
        if name in found and not extras:
            continue
        try:
            texts = distribution(name).requires or ()
        except PackageNotFoundError:
            continue  # Required on other platforms, or by an extra that is not installed.
        found.add(name)
        open_names += [
            (canonicalize_name(requirement.name), frozenset(requirement.extras))
            for requirement in map(Requirement, texts)
            if _applies(requirement, extras)
        ]
    return found


def _applies(requirement: Requirement, extras: frozenset[str]) -> bool:
    marker = requirement.marker
    return marker is None or any(marker.evaluate({"extra": extra}) for extra in extras or {""})


def size(name: str) -> int:
    """Return the bytes of the files of a distribution, compiled modules not included."""
    paths = [Path(str(file.locate())) for file in distribution(name).files or ()]
    return sum(path.stat().st_size for path in paths if path.is_file() and path.suffix != ".pyc")


def import_time(statements: Iterable[str]) -> Spread:
    """Measure imports in new processes; one more process fills the caches of the system."""
    body = "\n".join(sorted(statements))
    code = f"import time\nbegin = time.perf_counter()\n{body}\nprint(time.perf_counter() - begin)"
    return spread([_run(code) for _ in range(RUNS + 1)][1:])


def _run(code: str) -> float:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return float(done.stdout)


def measure(name: str, extra: str, required: Iterable[str]) -> Dependency:
    """Measure a dependency; ``required`` are all that are installed without extras."""
    used = imports(MODULES.get(name, name))
    others = installed(other for other in required if other != name)
    saved = sum(map(size, installed([name]) - others))
    seconds = import_time(set().union(*used.values()))
    return Dependency(name, distribution(name).version, extra, size(name), saved, seconds, sorted(used))


def main() -> None:
    """Measure all run-time dependencies."""
    extras = requirements()
    required = [name for name, extra in extras.items() if not extra]
    rows = [measure(name, extra, required) for name, extra in extras.items()]
    everything = installed(required)
    write(
        "dependencies",
        "make dependencies",
        runs=RUNS,
        total=sum(map(size, everything)),
        distributions=len(everything),
        required=sorted((row for row in rows if not row.extra), key=lambda row: -row.saved),
        optional=[row for row in rows if row.extra],
    )


if __name__ == "__main__":
    main()
