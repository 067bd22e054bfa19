"""Errors: location, problem and hint on one line, a stable code, and the built-in error
that each also is.
"""

import inspect

import pytest

import uplift
from uplift.atlas.sources import read_atlas
from uplift.common import errors
from uplift.common.errors import (
    AtlasError,
    UnknownNameError,
    UpliftError,
    UpliftWarning,
    unknown_name,
)
from uplift.extras.looks.look import Look

CLASSES = [
    kind
    for _, kind in inspect.getmembers(errors, inspect.isclass)
    if issubclass(kind, UpliftError)
]


def test_message_is_location_problem_and_hint():
    error = AtlasError(
        "no samples",
        code="no-samples",
        path="a.txt",
        line=3,
        entry="red",
        hint="add some",
    )
    assert str(error) == "a.txt:3: entry 'red': no samples; add some"
    assert error.where == "a.txt:3: entry 'red'"
    assert error.to_json() == {
        "code": "no-samples",
        "where": "a.txt:3: entry 'red'",
        "problem": "no samples",
        "hint": "add some",
    }


def test_message_is_one_line_for_any_texts():
    error = UpliftError(
        "no such\nfile", path="a\x1b[2J", entry="b\u202e", hint="look\relsewhere"
    )
    assert str(error) == "a\\x1b[2J: entry 'b\\u202e': no such\\nfile; look\\relsewhere"
    assert str(AtlasError("no samples")) == "no samples"


@pytest.mark.parametrize("kind", CLASSES)
def test_every_error_class_is_exported_by_the_package(kind):
    assert getattr(uplift, kind.__name__) is kind


def test_unknown_name_does_not_suggest_itself():
    assert "'Raw'" not in unknown_name("Raw", ("Raw", "sRGB"), "RGB space").hint


def test_unknown_name_suggests_near_names_regardless_of_case():
    error = unknown_name("d56", ("D50", "D55", "D65", "A"), "illuminant")
    assert isinstance(error, UnknownNameError)
    assert error.code == "unknown-name"
    assert error.problem == "unknown illuminant 'd56'"
    assert "'D65'" in error.hint
    assert "'A'" not in error.hint


def test_warnings_name_the_line_of_the_caller(tmp_path):
    percents = tmp_path / "percents.csv"
    percents.write_text("name,400,550,700\na,10,20,30\n")
    with pytest.warns(UpliftWarning) as of_build:
        uplift.build(dim=2, looks=Look("#ff0000", {"A": "#00ff00"}))
    with pytest.warns(UpliftWarning) as of_read:
        read_atlas(percents)
    warnings = [*of_build, *of_read]
    assert [warning.filename for warning in warnings] == [__file__, __file__]
