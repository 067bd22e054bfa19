"""Numbers on the command line that Python parses or that overflow: each is one line."""

from __future__ import annotations

import click
import pytest
from click.testing import CliRunner
from uplift_cli.commands.build import LatticeDim
from uplift_cli.main import COMMANDS, main
from uplift_cli.options import Number

NUMBERS = ("nan", "inf", "-inf", "1e999", "1_0", "٣", "１", "9" * 5000, "", "0x10")


def numeric_options():
    """Every option that takes a number, by its command."""
    with click.Context(main) as context:
        commands = [main.get_command(context, name) for name in COMMANDS]
    groups = [each for each in commands if isinstance(each, click.Group)]
    commands += [each for group in groups for each in group.commands.values()]
    for command in commands:
        for option in command.params:
            if isinstance(option.type, Number | LatticeDim | click.types.IntParamType | click.types.FloatParamType):
                yield command, option


OPTIONS = list(numeric_options())


def test_all_numeric_options_are_found():
    assert {"--dim", "--threshold", "--processes", "--count", "--res"} <= {option.opts[-1] for _, option in OPTIONS}


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize(
    ("command", "option"), OPTIONS, ids=[f"{command.name}{option.opts[-1]}" for command, option in OPTIONS]
)
def test_invalid_numbers_are_refused_on_one_line(command, option, number):
    with pytest.raises(click.BadParameter) as caught:
        option.type.convert(number, option, None)
    assert caught.value.message.isprintable()
    assert len(caught.value.message) < 200


def test_whole_numbers_beyond_64_bits_are_refused():
    whole = [option for _, option in OPTIONS if not isinstance(option.type, Number)]
    assert len(whole) > 8
    for option in whole:
        with pytest.raises(click.BadParameter):
            option.type.convert("1" + 20 * "0", option, None)


@pytest.mark.parametrize(
    "args",
    [
        "query 1e308 0 0",
        "query ٣ 0 0",
        "query 0.1 0.2 0.3 --wavelengths 1e308",
        "query 0.1 0.2 0.3 --wavelengths 0:1e308:5e-324",
        f"query 0.1 0.2 0.3 --wavelengths {'9' * 5000}",
        "query 1e308 -1e308 5e-324 --out-of-gamut desaturate-oklab",
        "query 1e308 0.5 0.25 --out-of-gamut scale --input-space P3-D65",
        "mix 1e308:#ff0000 5e-324:#00ff00",
        "mix #ff0000 --thickness 1e308",
        "mix #ff0000 --thickness 5e-324",
    ],
    ids=lambda args: args[:60],
)
def test_extreme_numbers_are_answered_or_refused_on_one_line(args):
    result = CliRunner().invoke(main, args.split(), env={"COLUMNS": "160"})
    assert result.exit_code in (0, 1, 2)
    if result.exit_code:
        assert isinstance(result.exception, SystemExit)
        assert len(result.stderr.strip().splitlines()) == 1, result.stderr
    assert "nan" not in result.stdout
