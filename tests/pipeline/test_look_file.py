"""Files of looks, and the errors of invalid ones: code, line and name."""

from __future__ import annotations

import pytest

from tests.helpers import raises
from uplift import Look, LookError, read_looks

COMPLETE = """# Two looks
[[look]]
rgb = "#8a2a20"
FL11 = "#70392a"
A = [0.27, 0.02, 0.01]
weight = 0.5
name = "brick"

[[look]]
rgb = [0.1, 0.2, 0.3]
LED-B3 = "#5c7a94"
"FL3.1" = "#5c7a94"
"""


@pytest.fixture
def read(tmp_path):
    def read(text):
        (tmp_path / "looks.toml").write_text(text, encoding="utf-8")
        return read_looks(tmp_path / "looks.toml")

    return read


def test_complete_file(read):
    first, second = read(COMPLETE)
    assert first == Look("#8a2a20", {"FL11": "#70392a", "A": [0.27, 0.02, 0.01]}, 0.5, "brick")
    assert (second.name, second.weight) == ("look 0.1 0.2 0.3", 1.0)
    assert list(second.lights) == ["LED-B3", "FL3.1"]
    assert (first.line, second.line) == (2, 9)


HEAD = '[[look]]\nrgb = "#8a2a20"\n'


@pytest.mark.parametrize(
    ("text", "code", "line", "word"),
    [
        ("", "no-looks", None, "looks"),
        ("look = 3", "invalid-value", 1, "look"),
        ("[[looks]]\nrgb = '#8a2a20'", "unknown-key", 1, "did you mean 'look'"),
        ("[[look]]\nA = '#808080'", "missing-key", 1, "rgb"),
        (HEAD, "look", 1, "#8a2a20"),
        (HEAD + 'FL99 = "#808080"', "unknown-illuminant", 3, "FL9"),
        (HEAD + 'brightness = 1\nA = "#808080"', "unknown-illuminant", 3, "brightness"),
        (HEAD + 'A = "#80808"', "invalid-colour", 1, "A"),
        (HEAD + "A = [0.1, 0.2, 3]", "look", 1, "A"),
        (HEAD + 'FL3.1 = "#808080"', "invalid-value", 3, "quote"),
        (HEAD + 'A = "#808080"\nweight = 2', "look", 1, "weight"),
        (HEAD + 'A = "#808080"\nname = 2', "invalid-value", 4, "name"),
        (HEAD + 'A = "#808080"\n\n[[look]]\nrgb = [2, 0, 0]\nA = "#808080"', "look", 5, "rgb"),
        (HEAD + "A = #808080", "invalid-toml", 3, "value"),
    ],
)
def test_invalid_files_are_refused(read, tmp_path, text, code, line, word):
    with raises(LookError, code) as caught:
        read(text)
    assert (caught.value.path, caught.value.line) == (tmp_path / "looks.toml", line)
    assert word in str(caught.value)
    assert caught.value.hint
