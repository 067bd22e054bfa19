"""docs/errors.md lists the explicit codes of errors and warnings."""

import json

from tools.error_codes import collect

from .conftest import ROOT


def test_listed_codes_are_those_of_the_source():
    listed = json.loads((ROOT / "docs" / "data" / "errors.json").read_text("utf-8"))
    assert listed["codes"] == collect(), "run 'make docs'"
