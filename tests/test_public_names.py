"""Public names stay: docs/project/compatibility.md promises a release of warning before
one goes.
"""

import functools

import click
import pytest

from tools import public_names

stored = functools.cache(public_names.stored_names)
current = functools.cache(public_names.public_names)


def test_no_public_name_has_gone():
    gone = sorted(set(stored()) - set(current()))
    assert gone == [], "restore the names, or follow docs/project/compatibility.md"


def test_every_public_name_is_stored():
    new = sorted(set(current()) - set(stored()))
    assert new == [], "run 'make names'"


@pytest.mark.parametrize(
    "name",
    [
        "command uplift lab study held-out",
        "error forked-process",
        "exit code 70",
        "reads uplift cube 3",
        "uplift query --mode refined",
        "uplift query -",
        "uplift.Cube.reflectance(wavelengths)",
        "uplift.build(dim)",
        "uplift.h uplift_open",
        "warning entry-clipped",
    ],
)
def test_names_of_all_kinds_are_among_them(name):
    assert any(line.startswith(name) for line in current())


def test_a_name_that_goes_is_noticed():
    command = click.Command("old", params=[click.Option(["--new", "--short"])])
    with click.Context(command, info_name="old") as context:
        names = set(public_names.command_names(command, context))
    assert {"command old", "old --new", "old --short"} <= names
    assert "old --gone" not in names
