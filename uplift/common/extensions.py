"""Parts that rooms outside the core, and other distributions, add to it.

The core knows their kinds and names, not their modules. `uplift` registers its own when
it is imported; another distribution has an entry point in the group ``uplift.KIND``.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any

_LOCATIONS: dict[tuple[str, str], str] = {}


def register(kind: str, name: str, location: str) -> None:
    """Register a part by its location, ``"module:name"``, which is imported when it is
    first used.
    """
    _LOCATIONS[kind, name] = location


def extension(kind: str, name: str) -> Any:
    """Import the part that is registered under a kind and a name. Raise `OptionError`
    for a part that is not installed.
    """
    if (kind, name) not in _LOCATIONS:
        from uplift.common.errors import OptionError  # `import uplift` stays light

        raise OptionError(
            f"{kind} '{name}' is not a part of this installation",
            hint="install all of uplift",
        )
    return import_part(_LOCATIONS[kind, name])


def import_part(location: str) -> Any:
    """Import ``"module:name"``."""
    module, _, attribute = location.partition(":")
    return getattr(import_module(module), attribute)


def registered(kind: str) -> list[Any]:
    """Import all parts of a kind that are registered, in order."""
    return [extension(kind, name) for known, name in _LOCATIONS if known == kind]


def installed(kind: str) -> dict[str, Callable[[], Any]]:
    """Return functions that import the parts of a kind that other distributions have as
    entry points, by name.
    """
    from importlib.metadata import entry_points

    return {point.name: point.load for point in entry_points(group=f"uplift.{kind}")}
