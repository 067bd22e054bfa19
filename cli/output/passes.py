"""Passes, and the numbers of lights and colours in them, as tables, JSON and CSV."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from uplift.common.text import pluralise

from .answers import format_rgb
from .console import make_table, print_csv, print_json, say, show

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.scene.passes.passes import Passes

BOUNCES = ("1 bounce", "2", "3", "4", "mean")


def passes_count(passes: Passes) -> str:
    return "1 pass" if passes.count == 1 else f"{passes.count} passes"


def mean_rows(errors: Array) -> list[list[float]]:
    return [[*row.tolist(), float(row.mean())] for row in errors]


def passes_fields(passes: Passes) -> dict[str, Any]:
    """Return the contents of passes as JSON values."""
    from uplift.extras.scene.passes.file import passes_digest

    lights = {}
    for light in passes.lights:
        lights[light.name] = {
            "numbers": light.numbers.tolist(),
            "to_xyz": light.to_xyz.tolist(),
            "errors": light.errors.tolist(),
            "own_errors": light.own_errors.tolist(),
        }
    camera = None
    if passes.camera is not None:
        camera = {
            "name": passes.camera.name,
            "matrix": passes.camera.matrix.tolist(),
            "error": passes.camera.error,
        }
    return {
        "count": passes.count,
        "digest": passes_digest(passes),
        "centres": list(passes.bands.centres),
        "width": passes.bands.width,
        "to_xyz": passes.to_xyz.tolist(),
        "error": passes.error,
        "materials": dict(passes.origin),
        "lights": lights,
        "camera": camera,
    }


def print_passes(passes: Passes) -> None:
    """Print bands, numbers of lights and errors."""
    title = f"centres in nm, width {passes.bands.width:g} nm, and numbers of lights"
    bands = make_table(("",), ("R", "G", "B"), title=title)
    for number in range(passes.count):
        rows = slice(3 * number, 3 * number + 3)
        centres = [f"{centre:g} nm" for centre in passes.bands.centres[rows]]
        bands.add_row(f"pass {number + 1}", *centres)
        for light in passes.lights:
            bands.add_row(light.name, *map("{:.5g}".format, light.numbers[rows]))
    held_out = pluralise(passes.origin.get("held-out", 0), "material")
    title = f"mean ΔE00 on {held_out} that the choice did not use"
    table = make_table(("light",), BOUNCES, title=title)
    table.add_column("alone, mean")
    for light in passes.lights:
        cells = [*light.errors.tolist(), light.errors.mean(), light.own_errors.mean()]
        table.add_row(light.name, *map("{:.2f}".format, cells))
    show(bands, table)


def print_light_numbers(name: str, numbers: list[float]) -> None:
    """Print the numbers (K,) of a light, a line for each pass."""
    for number, triple in enumerate(_triples(numbers), 1):
        say(f"{name}, pass {number}: {_number_text(triple)}")


def print_numbers(rows: Iterable[tuple[list[float], list[float]]], style: str) -> None:
    """Print the numbers (K,) of passes of colours, three for each pass."""
    if style == "csv":
        print_csv(("r", "g", "b", "pass", "R", "G", "B"), _pass_rows(rows))
        return
    if style == "json":
        values = [{"rgb": rgb, "passes": _triples(numbers)} for rgb, numbers in rows]
        print_json(values)
        return
    for rgb, numbers in rows:
        say(f"linear RGB {format_rgb(rgb)}")
        for number, triple in enumerate(_triples(numbers), 1):
            say(f"  pass {number}: {_number_text(triple)}")


def _triples(numbers: list[float]) -> list[list[float]]:
    return [numbers[first : first + 3] for first in range(0, len(numbers), 3)]


def _number_text(numbers: list[float]) -> str:
    return " ".join(map("{:.6g}".format, numbers))


def _pass_rows(
    rows: Iterable[tuple[list[float], list[float]]],
) -> Iterator[list[float]]:
    for rgb, numbers in rows:
        for number, triple in enumerate(_triples(numbers), 1):
            yield [*rgb, number, *triple]
