"""Text that is safe to show."""

from __future__ import annotations

import json
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uplift.common.errors import UpliftError
from uplift.common.text import json_escapes, printable

ANY_TEXT = st.text(st.characters(exclude_categories=()))
"""Text of any code points, lone surrogates among them."""


@given(ANY_TEXT)
def test_printable_text_has_no_controls_and_can_be_encoded(text):
    shown = printable(text)
    shown.encode()
    assert not {unicodedata.category(character) for character in shown} & {"Cc", "Cs", "Zl", "Zp"}
    assert not {unicodedata.bidirectional(character) for character in shown} & {
        "LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI",
    }  # fmt: skip


@pytest.mark.parametrize("text", ["", "ΔE00 ≤ 1", "émail 青", "a\\b", "👩‍🔬"])
def test_printable_text_stays(text):
    assert printable(text) == text


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b]52;c;eA==\x07", "\\x1b]52;c;eA==\\x07"),
        ("a\r\nb", "a\\r\\nb"),
        ("\u202ex", "\\u202ex"),
        ("\udcff", "\\udcff"),
    ],
)
def test_escapes_are_those_of_python(text, shown):
    assert printable(text) == shown


@given(st.dictionaries(ANY_TEXT, ANY_TEXT), st.sampled_from([None, 2]))
def test_escaped_json_has_the_same_values_and_only_printable_lines(values, indent):
    text = json_escapes(json.dumps(values, ensure_ascii=False, indent=indent))
    assert json.loads(text) == values
    assert all(printable(line) == line for line in text.split("\n"))


def test_errors_are_one_line_for_any_texts():
    error = UpliftError("no such\nfile", path="a\x1b[2J", entry="b\u202e", hint="look\relsewhere")
    assert str(error) == "a\\x1b[2J: entry 'b\\u202e': no such\\nfile; look\\relsewhere"
    assert error.args == (str(error),)
