"""The documentation site: it builds without warnings, runs its notebooks, and needs no network to be read."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest
from uplift_cli.main import COMMANDS

from tests.conftest import ROOT
from tools.command_reference import command_reference

DOCS = ROOT / "docs"
NOTEBOOKS = sorted(DOCS.glob("notebooks/*.ipynb"))


def build(source, target):
    """Build a site as `make site` does."""
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-W",
        "--keep-going",
        "-q",
        "-b",
        "html",
        str(source),
        str(target),
    ]
    clean = {
        name: value for name, value in os.environ.items() if name != "MPLBACKEND"
    }  # commands in this process set it
    return subprocess.run(command, cwd=ROOT, env=clean, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, built once."""
    target = tmp_path_factory.mktemp("site")
    result = build(DOCS, target)
    findings = [line for line in result.stderr.splitlines() if re.search(r": (?:WARNING|ERROR): ", line)]
    assert result.returncode == 0, "\n".join(findings) or result.stderr
    return target


def test_every_page_is_built(site):
    pages = [path.relative_to(DOCS).with_suffix(".html") for path in (*DOCS.rglob("*.md"), *NOTEBOOKS)]
    assert len(pages) > 30
    assert [page for page in pages if not (site / page).is_file()] == []


def test_notebooks_have_run(site):
    assert len(NOTEBOOKS) == 4
    for notebook in NOTEBOOKS:
        page = (site / notebook.relative_to(DOCS)).with_suffix(".html").read_text(encoding="utf-8")
        assert "cell_output" in page
        assert "data:image" in page or "<img" in page


def test_no_page_loads_from_the_network(site):
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        loaded = re.findall(r'(?:src|<link[^>]*href)="(https?:[^"]+)"', text)
        assert loaded == [], page.name


def test_broken_link_fails_the_build(tmp_path):
    (tmp_path / "conf.py").write_text((DOCS / "conf.py").read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "index.md").write_text("# Index\n\n[nowhere](missing.md)\n", encoding="utf-8")
    result = build(tmp_path, tmp_path / "out")
    assert result.returncode == 1
    assert "missing.md" in result.stderr


def test_reference_has_every_command():
    reference = command_reference()
    for name in COMMANDS:
        assert f"\n### uplift {name}\n" in reference
    assert "\n### uplift study moments\n" in reference
    assert "| `--dim DIM` |" in reference
