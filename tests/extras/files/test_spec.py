"""Reading and validation of specifications: locations, limits, control characters."""

import tracemalloc
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import model_validator

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import PaletteError, PlanFileError
from uplift.extras.files.spec import (
    SPEC,
    FolderPath,
    Matrix,
    Number,
    Row,
    SpecFolder,
    SpecModel,
    check_shape,
    problem,
    read_spec,
    resolves,
)


@dataclass(frozen=True, eq=False)
class Lamp:
    """A dataclass as a table."""

    __pydantic_config__ = SPEC

    to_xyz: Matrix
    numbers: Row
    light: Annotated[str, resolves(observer.illuminant_spd)] = "D65"


class Table(SpecModel):
    """A table of all kinds of values."""

    max_value: Number = 1.0
    lamps: tuple[Lamp, ...] = ()
    file: FolderPath | None = None

    @model_validator(mode="after")
    def _check(self):
        for row, lamp in enumerate(self.lamps):
            check_shape(lamp.to_xyz, (1, 2), "lamps", row, "to-xyz")
        if self.max_value == 7:
            raise problem("must be negative, got 7", "lower it", at=("max-value",))
        return self


@pytest.fixture
def read(tmp_path):
    """A function that reads TOML text."""

    def read(text, model=Table, **options):
        (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
        return read_spec(tmp_path / "spec.toml", model, PaletteError, **options)

    return read


def test_tables_have_hyphens_arrays_and_files_of_their_folder(read, tmp_path):
    folder = SpecFolder(tmp_path)
    lamp = "[[lamps]]\nto-xyz = [[1, 2]]\nnumbers = [1, 2.5]"
    table = read(f"max-value = 3\nfile = 'a/b.txt'\n{lamp}", folder=folder)
    assert table.max_value == 3
    assert table.file == tmp_path / "a/b.txt"
    assert folder.opened == [table.file]
    assert np.array_equal(table.lamps[0].to_xyz, [[1, 2]])
    assert np.array_equal(table.lamps[0].numbers, [1, 2.5])


LAMP = "[[lamps]]\nto-xyz = [[1, 2]]\nnumbers = [1]"


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ("max_value = 3", "max_value: unknown key"),
        ("max-value = 7", "max-value must be negative, got 7"),
        ("max-value = '3'", "max-value must be"),
        ("lamps = [3]", "lamps[0] must be a table, got 3"),
        ("[[lamps]]\nnumbers = [1]", "lamps[0].to-xyz: required key is missing"),
        (LAMP.replace("[1]", "[nan]"), "lamps[0].numbers[0] must be"),
        (
            LAMP.replace("2]]", "2, 3]]"),
            "lamps[0].to-xyz must be 1 × 2 numbers, got 1 × 3",
        ),
        ("file = '/etc/passwd'", "file must lie in the folder"),
        (LAMP.replace("2]]", "2], [3]]"), "lamps[0].to-xyz must have rows"),
        (r'file = "a\u0000"', "file must be a path"),
        ("file = 'a/../../b'", "file must lie in the folder"),
    ],
)
def test_errors_name_the_key_path(read, text, start):
    with raises(PaletteError, "invalid-file") as caught:
        read(text)
    assert caught.value.problem.startswith(start)
    assert caught.value.path.name == "spec.toml"


def test_look_ups_keep_their_code_and_other_errors_get_the_hint(read):
    with raises(PaletteError, "unknown-name") as caught:
        read(f"{LAMP}\nlight = 'D66'")
    assert caught.value.problem == "lamps[0].light: unknown illuminant 'D66'"
    assert "D65" in caught.value.hint
    for text, hint in (("max-value = 7", "lower it"), ("max-value = '3'", "again")):
        with raises(PaletteError, "invalid-file") as caught:
            read(text, hint="again")
        assert caught.value.hint == hint


class Keys(SpecModel, extra="allow"):
    """A table of any keys."""

    a: Any = None


@pytest.mark.parametrize("text", ["{} = 1", "[{}]", "[[{}]]", "a = { {} = 1 }"])
@pytest.mark.parametrize("parts", [["a"], ['"a"', " b\t"]])
def test_long_dotted_keys_are_refused_before_they_are_parsed(read, text, parts):
    tracemalloc.start()
    with raises(PaletteError, "invalid-file"):
        read(text.replace("{}", ".".join(5000 * parts)), Keys)
    assert tracemalloc.get_traced_memory()[1] < 30_000_000
    tracemalloc.stop()


@pytest.mark.parametrize("quote", ['"', "'", '"""', "'''"])
def test_points_in_texts_are_no_keys(read, quote):
    text = ".".join(100 * ["a"])
    assert read(f"a = {quote}{text}{quote} # {text}", Keys).a == text


def nested(depth):
    return b'{"a":' * depth + b"1" + b"}" * depth


@pytest.mark.parametrize(
    ("kind", "data", "is_valid"),
    [
        ("TOML", b"\x89PNG\r\n\x1a\n", False),
        ("TOML", "é = 1".encode("latin-1"), False),
        ("TOML", "a = 1".encode("utf-8-sig"), True),
        ("JSON", b"[]", False),
        ("JSON", b'{"a": NaN}', False),
        ("JSON", nested(20), True),
        ("JSON", nested(40), False),
    ],
)
def test_other_files_are_refused(tmp_path, kind, data, is_valid):
    path = tmp_path / "a"
    path.write_bytes(data)
    if is_valid:
        assert read_spec(path, Keys, PlanFileError, kind=kind).a
    else:
        with raises(PlanFileError, "invalid-file"):
            read_spec(path, Keys, PlanFileError, kind=kind)
