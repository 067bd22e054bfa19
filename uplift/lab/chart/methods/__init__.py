"""The methods of the chart, a file for each publication. To add one, add its file, with the name FAMILIES in it."""

from __future__ import annotations

from fnmatch import fnmatchcase
from importlib import import_module
from pkgutil import iter_modules

from uplift.common.errors import OptionError
from uplift.lab.chart.method import Family, Method


def found() -> tuple[Family, ...]:
    """The families of all files here."""
    files = (import_module(file.name) for file in iter_modules(__path__, f"{__name__}."))
    return tuple(family for file in files for family in file.FAMILIES)


FAMILIES = found()


def chosen(patterns: tuple[str, ...] = (), *, quick: bool = False) -> list[tuple[Family, Method]]:
    """Methods whose names match any of the patterns (``*`` and ``?`` as in a shell); without one, the usual.

    Raises `OptionError` for a pattern that matches none.
    """
    every = [(family, method) for family in FAMILIES for method in family.methods]
    if not patterns:
        return [(family, method) for family, method in every if (method.quick if quick else method.usual)]
    for pattern in patterns:
        if not any(fnmatchcase(method.name, pattern) for _, method in every):
            some = ", ".join(f"'{family.methods[0].name}'" for family in FAMILIES)
            raise OptionError(
                f"no method is called '{pattern}'", hint=f"name some as {some}; '*' stands for any"
            )
    return [
        (family, method)
        for family, method in every
        if any(fnmatchcase(method.name, pattern) for pattern in patterns)
    ]
