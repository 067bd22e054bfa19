"""Tables of a spec, read key by key: what is missing, of another kind or unknown is said with its place."""

from __future__ import annotations

import difflib
import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import PaletteError

HEX = 7
"""Characters of '#rrggbb'."""
CHANNELS = 3
LARGEST = 1e6
"""What is larger is a slip, and no number to solve equations with."""
NAME = re.compile(r"[^\W_][\w .+-]*(?<! )")
"""Names go into tables, pictures and atlases."""


@dataclass
class Fields:
    """A table of a spec; ``place`` is its name there. Every key is to be taken once, then `finish` is called."""

    path: str | os.PathLike[str]
    place: str
    values: Mapping[str, Any]
    taken: list[str] = field(default_factory=list)

    def has(self, key: str) -> bool:
        return key in self.values

    def table(self, key: str) -> Fields:
        """A table in it, empty where there is none."""
        found = self._take(key, {})
        if not isinstance(found, dict):
            raise self.error(f"'{key}' is no table", f"write it as [{self._name(key)}]")
        return Fields(self.path, self._name(key), found)

    def tables(self, key: str) -> list[Fields]:
        """An array of tables, empty where there is none."""
        found = self._take(key, [])
        if not isinstance(found, list) or not all(isinstance(one, dict) for one in found):
            raise self.error(f"'{key}' is no list of tables", f"write each as [[{self._name(key)}]]")
        return [Fields(self.path, self._name(key), one) for one in found]

    def text(self, key: str, default: str | None = None) -> str:
        found = self._take(key, default)
        if not isinstance(found, str):
            raise self.error(f"'{key}' is {_told(found)}", "write a text in quotes")
        return found

    def number(self, key: str, default: float | None = None, least: float = -math.inf) -> float:
        found = self._take(key, default)
        if not _is_small(found):
            raise self.error(f"'{key}' is {_told(found)}", f"write a number of at most {LARGEST:,.0f}")
        if found < least:
            raise self.error(f"'{key}' is {found:g}", f"write a number of at least {least:g}")
        return float(found)

    def true(self, key: str) -> None:
        if self._take(key, None) is not True:
            raise self.error(f"'{key}' is {_told(self.values[key])}", f"write {key} = true or leave it out")

    def bounds(self, key: str, default: tuple[float, float]) -> tuple[float, float]:
        """[low, high], or false for none."""
        found = self._take(key, list(default))
        if found is False:
            return -math.inf, math.inf
        numbers = isinstance(found, list) and all(
            _is_small(one) or one in (-math.inf, math.inf) for one in found
        )
        if not numbers or len(found) != 2 or not found[0] < found[1]:
            raise self.error(f"'{key}' is {_told(found)}", "write [low, high] or false")
        return float(found[0]), float(found[1])

    def names(self, key: str, count: int) -> tuple[str, ...]:
        found = self._take(key, None)
        if not isinstance(found, list) or len(found) != count or not all(isinstance(n, str) for n in found):
            raise self.error(f"'{key}' is {_told(found)}", f"write a list of {count} names")
        return tuple(found)

    def colour(self, key: str, sensor: Sensor, default: str | None = None) -> Array:
        """Linear RGB (3,) of '#rrggbb', or of three linear numbers."""
        return self.as_colour(key, self._take(key, default), sensor)

    def as_colour(self, key: str, found: object, sensor: Sensor) -> Array:
        try:
            if isinstance(found, str) and len(found) == HEX and found[0] == "#":
                return sensor.decode(list(bytes.fromhex(found[1:])))
        except ValueError:
            pass
        if isinstance(found, list) and len(found) == CHANNELS and all(map(_is_small, found)):
            return np.array(found, dtype=float)
        raise self.error(
            f"'{key}' is {_told(found)}, no colour", "write '#cc3319', or linear [0.6, 0.03, 0.01]"
        )

    def name(self, name: str) -> str:
        """The name of a part, if it is a plain one."""
        if not NAME.fullmatch(name):
            raise self.error(
                f"{_told(name)} is no name", "write letters, digits, blanks, '.', '+', '-' and '_'"
            )
        return name

    def finish(self) -> None:
        """Refuse keys that nobody took."""
        for key in self.values:
            if key not in self.taken:
                raise self.unknown(key, self.taken, "key")

    def unknown(self, name: str, known: list[str], kind: str) -> PaletteError:
        """The error for a name that means nothing here, with those that do."""
        near = difflib.get_close_matches(name, known, n=3, cutoff=0.4) or known[:6]
        choices = ", ".join(f"'{one}'" for one in near)
        return self.error(f"unknown {kind} '{name}'", f"did you mean {choices}?" if near else "there is none")

    def error(self, problem: str, hint: str) -> PaletteError:
        place = f"[{self.place}]: " if self.place else ""
        return PaletteError(place + problem, path=self.path, hint=hint)

    def _take(self, key: str, default: object) -> Any:
        self.taken.append(key)
        if key not in self.values and default is None:
            raise self.error(f"'{key}' is missing", "add it")
        return self.values.get(key, default)

    def _name(self, key: str) -> str:
        return f"{self.place}.{key}" if self.place else key


def _is_small(found: object) -> bool:
    """Whether it is a number that one may compute with."""
    return isinstance(found, int | float) and not isinstance(found, bool) and abs(found) <= LARGEST


def _told(found: object) -> str:
    text = repr(found)
    return text if len(text) <= 40 else text[:40] + "…"
