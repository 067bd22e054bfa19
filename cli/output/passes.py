"""Passes, and the numbers of lights and colours in them, as rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from uplift.common.text import pluralise

from .console import print_json
from .table import Table, print_result

if TYPE_CHECKING:
    from uplift.extras.scene.passes.passes import Passes

CHANNELS = "RGB"
ERRORS = ("light", "1 bounce", "2", "3", "4", "mean", "alone, mean")


def passes_count(passes: Passes) -> str:
    return "1 pass" if passes.count == 1 else f"{passes.count} passes"


def passes_fields(passes: Passes) -> dict[str, Any]:
    """Return the contents of passes as JSON values."""
    from uplift.extras.scene.passes.file import passes_digest

    lights = {light.name: _plain(light) for light in passes.lights}
    for light in lights.values():
        del light["name"], light["digest"]
    return {
        "count": passes.count,
        "digest": passes_digest(passes),
        "centres": list(passes.bands.centres),
        "width": passes.bands.width,
        "to_xyz": passes.to_xyz.tolist(),
        "error": passes.error,
        "materials": dict(passes.origin),
        "lights": lights,
        "camera": None if passes.camera is None else _plain(passes.camera),
    }


def _plain(table: object) -> dict[str, Any]:
    """Return the fields of a dataclass with lists in place of arrays."""
    fields = vars(table).items()
    return {
        name: value.tolist() if hasattr(value, "tolist") else value
        for name, value in fields
    }


def passes_tables(
    passes: Passes, others: Mapping[str, list[float]]
) -> tuple[Table, Table]:
    """Return the table of bands with the numbers of lights, also of ``others``, and
    that of errors.
    """
    numbers = [("centre, nm", list(passes.bands.centres))]
    numbers += [(light.name, light.numbers.tolist()) for light in passes.lights]
    numbers += others.items()
    rows = []
    for name, values in numbers:
        rows += [{"numbers of": name} | row for row in _rows(values)]
    bands = Table(
        sorted(rows, key=lambda row: row["pass"]),
        _headings("pass", "numbers of", *CHANNELS),
        title=f"bands of width {passes.bands.width:g} nm, and numbers of lights",
        digits=".5g",
    )
    errors = []
    for light in passes.lights:
        means = light.errors.mean(), light.own_errors.mean()
        cells = (light.name, *light.errors.tolist(), *map(float, means))
        errors.append(dict(zip(ERRORS, cells, strict=True)))
    held_out = pluralise(passes.origin.get("held-out", 0), "material")
    title = f"mean ΔE00 on {held_out} that the choice did not use"
    return bands, Table(errors, _headings(*ERRORS), title=title, digits=".2f")


def _headings(*names: str) -> dict[str, str]:
    return dict(zip(names, names, strict=True))


def print_numbers(rows: Iterable[tuple[list[float], list[float]]], style: str) -> None:
    """Print the numbers (K,) of passes of colours, three for each pass."""
    if style == "json":
        print_json([{"rgb": rgb, "passes": _triples(values)} for rgb, values in rows])
        return
    table = Table(
        _rows_of_colours(rows),
        {"rgb": "linear RGB", **_headings("pass", *CHANNELS)},
        digits=".6g",
        formats={"rgb": ".6f"},
    )
    print_result(style, None, table)


def _rows_of_colours(
    rows: Iterable[tuple[list[float], list[float]]],
) -> Iterator[dict[str, Any]]:
    for rgb, values in rows:
        for row in _rows(values):
            yield {"rgb": rgb} | row


def _triples(numbers: list[float]) -> list[list[float]]:
    return [numbers[first : first + 3] for first in range(0, len(numbers), 3)]


def _rows(numbers: list[float]) -> Iterator[dict[str, Any]]:
    """Yield a row of the numbers (K,) for each pass."""
    for number, triple in enumerate(_triples(numbers), 1):
        yield {"pass": number, **dict(zip(CHANNELS, triple, strict=True))}
