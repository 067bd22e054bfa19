"""Options of version 0.2 are errors that name what replaces them."""

import pytest
from uplift_cli.main import main
from uplift_cli.replaced import REPLACEMENTS

from .conftest import commands

CASES = [
    (command, old, new)
    for command, options in REPLACEMENTS.items()
    for old, new in options.items()
]


@pytest.mark.parametrize(("command", "old", "new"), CASES)
def test_old_names_are_errors_with_the_new_one(run, command, old, new):
    params = commands(main)[command].params
    known = {option for param in params for option in param.opts}
    assert old not in known
    if new.startswith("--"):
        assert new.partition(",")[0] in known
    result = run(f"{command} {old} 3", code=2)
    assert f"{new} replaces it." in result.stderr
