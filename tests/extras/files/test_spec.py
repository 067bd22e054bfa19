"""Reading and validation of TOML and JSON files: locations, limits and control
characters.
"""

import tracemalloc

import pytest

from tests.helpers import raises
from uplift.common.errors import PaletteError, PlanFileError
from uplift.extras.files.spec import SpecModel, read_json, read_toml


@pytest.fixture
def file(tmp_path):
    """A function that reads TOML text."""

    def read(text):
        (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
        return read_toml(tmp_path / "spec.toml", PaletteError)

    return read


def test_errors_name_the_key_path(file):
    with raises(PaletteError, "invalid-file") as caught:
        file("[[rows]]\n'inner' = { deep = 3 }").fail(
            ("rows", "~tag", 0, "inner", "deep"),
            "must be negative, got 3",
            hint="lower it",
        )
    assert caught.value.problem == "rows[0].inner.deep must be negative, got 3"
    assert caught.value.hint == "lower it"


class Table(SpecModel):
    """A table with an alias and a looked-up name."""

    max_value: int = 1
    name: str = ""


def test_keys_have_hyphens_and_unknown_ones_are_refused(file):
    assert file("max-value = 3").validate(Table).max_value == 3
    with raises(PaletteError, "invalid-file") as caught:
        file("max_value = 3").validate(Table)
    assert caught.value.problem == "max_value: unknown key"


@pytest.mark.parametrize(
    "text",
    [
        "{} = 1",
        "[{}]",
        "[[{}]]",
        "a = { {} = 1 }",
        "# {}\n{} = 1",
        "a = '''{}'''\n{} = 1",
    ],
)
@pytest.mark.parametrize("parts", [["a"], ['"a"', " b\t"]])
def test_long_dotted_keys_are_refused_before_they_are_parsed(file, text, parts):
    tracemalloc.start()
    with raises(PaletteError, "invalid-file"):
        file(text.replace("{}", ".".join(5000 * parts)))
    assert tracemalloc.get_traced_memory()[1] < 30_000_000
    tracemalloc.stop()


@pytest.mark.parametrize("quote", ['"', "'", '"""', "'''"])
def test_points_in_texts_are_no_keys(file, quote):
    text = ".".join(100 * ["a"])
    assert file(f"a = {quote}{text}{quote} # {text}").values == {"a": text}


@pytest.mark.parametrize(
    "data", [b"\x89PNG\r\n\x1a\n", b"v/1\x01", "é = 1".encode("latin-1"), bytes(9)]
)
def test_other_files_are_named(tmp_path, data):
    (tmp_path / "a.toml").write_bytes(data)
    with raises(PaletteError, "invalid-file") as caught:
        read_toml(tmp_path / "a.toml", PaletteError)
    assert "codec" not in caught.value.problem
    (tmp_path / "a.toml").write_text("a = 1", encoding="utf-8-sig")
    assert read_toml(tmp_path / "a.toml", PaletteError).values == {"a": 1}


@pytest.mark.parametrize("depth", [20, 40])
def test_nesting_is_limited(tmp_path, depth):
    path = tmp_path / "a.json"
    path.write_text('{"a":' * depth + "1" + "}" * depth)
    if depth < 32:
        assert read_json(path, PlanFileError).values
    else:
        with raises(PlanFileError, "invalid-file"):
            read_json(path, PlanFileError)
