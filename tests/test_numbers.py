"""Numbers in the prose of the documentation come from the code, from data, or from a
source that is named where they stand.
"""

import re

import pytest

from tests.conftest import ROOT
from tools.render_docs import pages, stated

UNIT = (
    r" ?%|-?fold| times\b| ?(?:ms|µs|ns|kB|MB|GB)\b| (?:s|seconds|minutes|hours)\b| "
    r"million\b"
)
NUMBER = re.compile(
    rf"(?<![\w.,:/#§-])\d[\d,]*(?:\.\d+)?(?={UNIT})"
    r"|(?<![\w.])(?:\d*\.\d+|\d+(?:\.\d+)?e[-−]?\d+|10⁻[⁰¹²³⁴-⁹]+)(?!\w|\.\d)"
    r"|(?<=ΔE00 )\d[\d.]*|(?<=ΔE76 )\d[\d.]*"
)
"""Numbers that a measurement may have given: with a unit, a fraction or an exponent."""
PLACES = re.compile(
    r"(?:[Ss]ections?|eq\.|equations?|[Tt]ables?|[Ff]igures?|chapters?|Tódová(?: "
    r"2020)?,(?: section)?|Prague 2020,"
    r"|Fishkin|thesis|2006,) \(?[\d.]+(?:(?:–|, | and "
    r")[\d.]+)*|\(\d{1,2}(?:\.\d{1,2})+(?:, \d{1,2}(?:\.\d{1,2})+)*\)"
)
"""Sections, equations and figures of a source."""
VERSIONS = re.compile(
    r"(?:Python|Mitsuba|Blender|GLSL \(|ES|colour-science\]?,?|uplift) [\d.]+|GLSL "
    r"\([\d.]+|\bES [\d.]+"
)


def prose(path):
    """Text of a page with code, tables, addresses, and what a template fills in,
    blanked.
    """
    text = path.read_text(encoding="utf-8")
    for pattern in (r"```.*?```", r"\{% call.*?endcall %\}"):
        text = re.sub(pattern, "", text, flags=re.DOTALL)
    text = re.sub(r"\{%.*?%\}|\{\{.*?\}\}|\{#.*?#\}", "◊", text, flags=re.DOTALL)
    text = re.sub(r"\]\([^)]*\)", "]", re.sub(r"`[^`\n]*`", "`…`", text))
    text = "\n".join(
        "" if line.startswith(("|", "    ")) else line for line in text.splitlines()
    )
    return VERSIONS.sub("", PLACES.sub("", text))


def sources():
    """Pages written by hand, and templates in place of the pages that they make."""
    generated = {ROOT / "docs" / f"{name}.md" for name in pages()}
    written = {*ROOT.glob("docs/**/*.md")} - generated
    exempt = {"coverage.md"}
    return [
        *(path for path in sorted(written) if path.name not in exempt),
        *sorted(ROOT.glob("docs/templates/**/*.md.j2")),
    ]


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.name)
def test_prose_has_no_number_of_its_own(path):
    text = prose(path)
    typed = [
        text[max(0, match.start() - 40) : match.end() + 20]
        for match in NUMBER.finditer(text)
    ]
    assert typed == []


def test_a_stated_number_stands_in_its_source():
    assert stated("2e−7", "uplift/models/model.py") == "2e−7"
    with pytest.raises(ValueError, match="does not have"):
        stated("3e−7", "uplift/models/model.py")
