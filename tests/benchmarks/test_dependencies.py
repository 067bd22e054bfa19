"""The page of dependencies covers pyproject.toml, and its measurements are right."""

from __future__ import annotations

import ast
import json
from importlib.metadata import distribution

import pytest

from benchmarks import dependencies
from tests.conftest import ROOT

STORED = json.loads((ROOT / "docs" / "data" / "dependencies.json").read_text(encoding="utf-8"))


def test_page_has_exactly_the_dependencies_of_pyproject():
    rows = STORED["required"] + STORED["optional"]
    assert {row["name"]: row["extra"] for row in rows} == dependencies.requirements(), "run 'make dependencies'"


@pytest.mark.parametrize("name", dependencies.requirements())
def test_every_dependency_is_used(name):
    assert dependencies.imports(dependencies.MODULES.get(name, name))


def test_an_unused_dependency_has_no_imports():
    assert dependencies.imports("filelock") == {}


def test_imports_for_type_checkers_do_not_count():
    tree = ast.parse(
        "import scipy.linalg as la\nfrom scipy import stats\nimport scipyx\nfrom .scipy import a\n"
        "if TYPE_CHECKING:\n    import scipy.signal\ndef f():\n    from scipy.optimize import lsq_linear"
    )
    assert [found for module, found in dependencies.import_statements(tree) if module == "scipy"] == [
        "import scipy.linalg as la",
        "from scipy import stats",
        "from scipy.optimize import lsq_linear",
    ]


def test_installed_includes_requirements_of_requirements():
    assert dependencies.installed(["jinja2"]) == {"jinja2", "markupsafe"}
    assert {"matplotlib", "pillow", "numpy"} <= dependencies.installed(["matplotlib"])
    assert dependencies.installed(["not-a-distribution"]) == set()


def test_size_is_that_of_the_files():
    package = distribution("click").locate_file("click")
    sources = sum(path.stat().st_size for path in package.rglob("*.py"))
    assert sources <= dependencies.size("click") < 2 * sources


def test_import_time_excludes_the_start_of_python(monkeypatch):
    monkeypatch.setattr(dependencies, "RUNS", 3)
    short, long = (dependencies.import_time([f"time.sleep({seconds})"]) for seconds in (0, 0.2))
    assert short.median < 0.01
    assert long.median >= 0.2
    assert long.runs == 3
