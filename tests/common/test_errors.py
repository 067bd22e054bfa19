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


def test_message_is_one_line_of_location_problem_and_hint():
    error = AtlasError("no\nfile", path="a\x1b", line=3, entry="b\u202e", hint="look\r")
    assert str(error) == "a\\x1b:3: entry 'b\\u202e': no\\nfile; look\\r"
    assert str(AtlasError("no samples")) == "no samples"


@pytest.mark.parametrize("kind", CLASSES)
def test_every_error_class_is_exported_by_the_package(kind):
    assert getattr(uplift, kind.__name__) is kind


def test_unknown_name_suggests_near_names_regardless_of_case():
    error = unknown_name("d56", ("D50", "D55", "D65", "A"), "illuminant")
    assert error.code == "unknown-name"
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
