"""Numbers in the prose of the documentation: each is listed in docs/data/claims.toml
and agrees with its source.
"""

import importlib
import inspect
import json
import re
import tomllib
from math import isclose

import pytest

from tests.conftest import ROOT
from tools.render_docs import pages
from uplift.extras.export import write_program

CLAIMS = tomllib.loads((ROOT / "docs/data/claims.toml").read_text(encoding="utf-8"))[
    "claim"
]
SOURCES = ("code", "data", "test", "printed", "meaning")
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


def spans(text, claims):
    """Places of the numbers of claims in a text; a claim that does not
    occur has none.
    """
    found = []
    for claim in claims:
        before, number, after = re.split("[«»]", claim["text"])
        found += [
            (match.start() + len(before), number)
            for match in re.finditer(re.escape(before + number + after), text)
        ]
    return found


def unlisted(text, claims):
    """Numbers of a text that no claim covers, each with the words around it."""
    listed = {start for start, _ in spans(text, claims)}
    return [
        text[max(0, match.start() - 40) : match.end() + 20]
        for match in NUMBER.finditer(text)
        if match.start() not in listed
    ]


def as_number(text):
    """Value of a number as written: 2e−7, 10⁻⁸, 0.95."""
    plain = text.replace("−", "-").replace(",", "")
    power = re.fullmatch(r"10⁻([⁰¹²³⁴-⁹]+)", plain)
    return (
        10.0 ** -int(power[1].translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")))
        if power
        else float(plain)
    )


def digits(text):
    """Half of the last digit of a number as written."""
    mantissa, _, exponent = text.replace("−", "-").replace(",", "").partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def from_code(claim):
    """Constant of the code; a function is called with ``argument``."""
    module, _, path = claim["code"].partition(":")
    value = importlib.import_module(module)
    for key in path.split("."):
        value = value[int(key)] if key.isdigit() else getattr(value, key)
    return value(claim["argument"]) if inspect.isfunction(value) else value


def label(claim):
    return claim["text"][:40]


def from_data(path):
    """Datum at ``file.json: key[name=value].0``."""
    file, _, keys = path.partition(": ")
    value = json.loads((ROOT / "docs/data" / file).read_text(encoding="utf-8"))
    for key in keys.split("."):
        name, _, where = key.partition("[")
        value = value[int(name)] if name.isdigit() else value[name]
        if where:
            wanted = dict(pair.split("=") for pair in where.rstrip("]").split(","))
            (value,) = [
                row
                for row in value
                if all(str(row[one]) == other for one, other in wanted.items())
            ]
    return value


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.name)
def test_every_number_is_listed(path):
    page = path.relative_to(ROOT).as_posix()
    assert (
        unlisted(prose(path), [claim for claim in CLAIMS if claim["page"] == page])
        == []
    )


@pytest.mark.parametrize("claim", CLAIMS, ids=label)
def test_claim_occurs_and_names_one_source(claim):
    assert spans(prose(ROOT / claim["page"]), [claim]) != []
    assert len([key for key in SOURCES if claim.get(key)]) == 1
    assert ("data" in claim) == ("command" in claim)


@pytest.mark.parametrize(
    "claim", [claim for claim in CLAIMS if {"code", "data"} & claim.keys()], ids=label
)
def test_number_agrees_with_its_source(claim):
    number = re.split("[«»]", claim["text"])[1]
    stated = (
        as_number(number)
        / (100 if claim.get("percent") else 1)
        * (-1 if claim.get("negative") else 1)
    )
    actual = from_code(claim) if "code" in claim else from_data(claim["data"])
    if "value" in claim:
        assert isclose(actual, claim["value"]), number
    else:
        assert abs(actual - stated) <= digits(number) + 1e-15, (number, actual)


@pytest.mark.parametrize(
    "claim", [claim for claim in CLAIMS if "test" in claim], ids=label
)
def test_named_file_has_the_number(claim):
    value = as_number(re.split("[«»]", claim["text"])[1])
    text = (ROOT / claim["test"]).read_text(encoding="utf-8")
    assert value in {
        float(each) for each in re.findall(r"\d+(?:\.\d+)?(?:e-?\d+)?", text)
    }


def test_a_header_of_32_nodes_has_about_5_megabytes(tmp_path, macbeth_cube):
    path = tmp_path / "cube.h"
    write_program(macbeth_cube.data, path)
    assert 4.5e6 < path.stat().st_size < 5.5e6
