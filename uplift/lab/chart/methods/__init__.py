"""Methods of the chart, one module for each publication; a new module needs a tuple ``FAMILIES``."""

from __future__ import annotations

from fnmatch import fnmatchcase
from importlib import import_module
from pkgutil import iter_modules

from uplift.common.errors import OptionError
from uplift.lab.chart.method import Family, Method

__all__ = ["FAMILIES", "load_families", "select_methods"]


def load_families() -> tuple[Family, ...]:
    """Import all modules of this package."""
    modules = (import_module(module.name) for module in iter_modules(__path__, f"{__name__}."))
    return tuple(family for module in modules for family in module.FAMILIES)


FAMILIES = load_families()


def select_methods(patterns: tuple[str, ...] = (), *, quick: bool = False) -> list[tuple[Family, Method]]:
    """Select methods by name. Raises `OptionError`."""
    methods = [(family, method) for family in FAMILIES for method in family.methods]
    if not patterns:
        return [(family, method) for family, method in methods if (method.quick if quick else method.usual)]
    for pattern in patterns:
        if not any(fnmatchcase(method.name, pattern) for _, method in methods):
            examples = ", ".join(f"'{family.methods[0].name}'" for family in FAMILIES)
            raise OptionError(
                f"no method matches '{pattern}'",
                code="unknown-method",
                hint=f"names are {examples} and others; '*' matches any characters",
            )
    return [
        (family, method) for family, method in methods if any(fnmatchcase(method.name, pattern) for pattern in patterns)
    ]
