"""Reading and validation of TOML and JSON files: locations, limits and control characters."""

from __future__ import annotations

import pytest

from tests.helpers import raises
from uplift.common.errors import PaletteError, PlanFileError
from uplift.common.spec_file import SpecModel, read_json, read_toml

TEXT = """title = "a = [b]"
point.x = 1
"quoted key" = 2

[table]
'inner' = { deep = 3 }

[[rows]]
name = "first"
[[rows]]
name = "second"
"""


@pytest.fixture
def file(tmp_path):
    """A function that reads TOML text."""

    def read(text=TEXT):
        (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
        return read_toml(tmp_path / "spec.toml", PaletteError)

    return read


@pytest.mark.parametrize(
    ("keys", "line", "dotted"),
    [
        (("title",), 1, "title"),
        (("point", "x"), 2, "point.x"),
        (("quoted key",), 3, "quoted key"),
        (("table",), 5, "table"),
        (("table", "inner", "deep"), 6, "table.inner.deep"),
        (("rows", 0, "name"), 9, "rows[0].name"),
        (("rows", 1, "name"), 11, "rows[1].name"),
        (("missing",), None, "missing"),
    ],
)
def test_errors_name_line_and_key_path(file, keys, line, dotted):
    with raises(PaletteError, "invalid-value") as caught:
        file().fail(keys, "must be positive, got -1", code="invalid-value", hint="raise it")
    assert caught.value.line == line
    assert caught.value.problem == f"{dotted} must be positive, got -1"
    assert caught.value.hint == "raise it"


class Table(SpecModel):
    """A table with an alias and a looked-up name."""

    max_value: int = 1
    name: str = ""


def test_keys_have_hyphens_and_unknown_ones_are_refused(file):
    assert file("max-value = 3").validate(Table).max_value == 3
    with raises(PaletteError, "unknown-key") as caught:
        file("max_value = 3").validate(Table)
    assert "'max-value'" in caught.value.hint


@pytest.mark.parametrize("depth", [20, 40])
def test_nesting_is_limited(tmp_path, depth):
    path = tmp_path / "a.json"
    path.write_text('{"a":' * depth + "1" + "}" * depth)
    if depth < 32:
        assert read_json(path, PlanFileError).values
    else:
        with raises(PlanFileError, "invalid-json"):
            read_json(path, PlanFileError)
