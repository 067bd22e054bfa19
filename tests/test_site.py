"""The documentation site: every page is there, notebooks have run, and no network is
needed to read it.
"""

import re

import pytest

from tests.conftest import ROOT

DOCS = ROOT / "docs"
SITE = ROOT / "out" / "site"
"""The folder that `make site` writes."""
NOTEBOOKS = sorted(DOCS.glob("notebooks/*.ipynb"))


@pytest.mark.site
def test_every_page_is_built():
    pages = [
        path.relative_to(DOCS).with_suffix(".html")
        for path in (*DOCS.rglob("*.md"), *NOTEBOOKS)
    ]
    assert len(pages) > 30
    assert [page for page in pages if not (SITE / page).is_file()] == []


@pytest.mark.site
def test_notebooks_have_run():
    assert len(NOTEBOOKS) == 4
    for notebook in NOTEBOOKS:
        page = (
            (SITE / notebook.relative_to(DOCS)).with_suffix(".html").read_text("utf-8")
        )
        assert "cell_output" in page
        assert "data:image" in page or "<img" in page


@pytest.mark.site
def test_no_page_loads_from_the_network():
    for page in SITE.rglob("*.html"):
        text = page.read_text("utf-8")
        loaded = re.findall(r'(?:src|<link[^>]*href)="(https?:[^"]+)"', text)
        assert loaded == [], page.name
