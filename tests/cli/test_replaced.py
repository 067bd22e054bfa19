"""Commands run under their old names; old options are errors that name what replaces
them.
"""

from itertools import chain

import pytest
from uplift_cli.main import main
from uplift_cli.replaced import REPLACED

from .conftest import commands

COMMANDS = {old: new for old, new in REPLACED.items() if " " not in old}
OPTIONS = [old.rsplit(" ", 1) for old in REPLACED if " " in old]


@pytest.mark.parametrize(("old", "new"), COMMANDS.items())
def test_commands_run_under_old_names_with_a_note(run, old, new):
    result = run(f"{old} --help")
    assert result.stdout == run(f"{new} --help").stdout == run(f"help {old}").stdout
    assert result.stderr == f"note: 'uplift {old}' is 'uplift {new}'\n"
    assert not run(f"{old} --help -q").stderr


@pytest.mark.parametrize(("command", "old"), OPTIONS)
def test_old_options_are_errors_with_the_new_one(run, command, old):
    new = REPLACED[f"{command} {old}"]
    if new.startswith("--"):
        params = commands(main)[command].params
        assert new.partition(",")[0] in chain(*(param.opts for param in params))
    assert f"{new} replaces it." in run(f"{command} {old} 3", code=2).stderr
