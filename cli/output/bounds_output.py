"""Bounds of answers as table, JSON or CSV."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

from uplift.lookup.light_errors import LIKELY

from ..startup import hide_drawing_notes
from .console import csv_writer, emit, make_table, print_json, say, show, terminal_json
from .query_output import format_rgb, hex_code, patch, print_fields, result_object

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lookup import Bounds, Cube, QueryResult

Block = tuple[Sequence["QueryResult"], Sequence["Bounds"]]
"""Answers, and their bounds under each light."""
Writer = Callable[["Cube", Iterable[Block], bool], None]
"""Prints blocks, each before the next one is computed."""
UNKNOWN = "–"
LIKELY_TITLE = f"likely {LIKELY:.0%}"
"""Heading of the error bounds: ΔE00 that this share of the materials like the atlas stay within."""


def write_bounds(
    cube: Cube,
    blocks: Iterable[Block],
    style: str,
    plot_path: str | None,
    html: str | None,
    *,
    single: bool,
    force: bool,
) -> None:
    """Print the bounds of answers, plot them and write their page."""
    if plot_path is not None or html is not None:
        blocks = list(blocks)
    if plot_path is not None:
        from uplift.viz.plots import plot_bounds

        hide_drawing_notes()
        plot_bounds(cube, [found for _, found in blocks], plot_path, force=force)
    if html is not None:
        from uplift.report.look_page import write_look_page

        write_look_page(cube, next(iter(blocks))[1], html, force=force)
        say(f"{html}: page to choose a look on", err=True)
    BOUNDS_WRITERS[style](cube, blocks, single)


def as_json(cube: Cube, blocks: Iterable[Block], single: bool) -> None:
    """Print one object for a colour given on the command line, else an array."""
    objects = chain.from_iterable(_objects(cube, *block) for block in blocks)
    if single:
        print_json(next(objects), indent=None)
        return
    for number, each in enumerate(objects):
        emit(("[\n" if number == 0 else ",\n") + terminal_json(each), nl=False)
    emit("\n]")


def _objects(cube: Cube, results: Sequence[QueryResult], found: Sequence[Bounds]) -> Iterable[dict[str, Any]]:
    for row, result in enumerate(results):
        yield result_object(cube, result) | {"bounds": {each.light.name: _object(each, row) for each in found}}


def _object(found: Bounds, row: int) -> dict[str, Any]:
    likely = found.likely(row)
    return {
        "lab": found.lab[row].tolist(),
        "largest_delta_e_2000": float(found.largest.delta_e_2000[row]),
        "largest_lab": _lab(found, found.largest.xyz[row]).tolist(),
        "outer_delta_e_2000": float(found.largest.outer[row]),
        "lab_range": found.box[row].tolist(),
        "share": float(found.share[row]),
        "outline": found.outline(row).tolist(),
        "covariance": None if found.covariance is None else found.covariance[row].tolist(),
        "likely": None if likely is None else likely.tolist(),
        "likely_share": LIKELY,
    }


def _lab(found: Bounds, xyz: Array) -> Array:
    from uplift.colorimetry.delta_e import lab

    return lab(xyz, found.light.white)


def as_csv(cube: Cube, blocks: Iterable[Block], single: bool) -> None:
    """Print a row per colour and light."""
    writer = csv_writer()
    lab_range = [f"{name}_{end}" for end in ("min", "max") for name in ("L*", "a*", "b*")]
    columns = ["r", "g", "b", "light", "L*", "a*", "b*", "standard_error", "error_bound"]
    writer.write([*columns, "largest", "outer", *lab_range, "share"])
    for results, found in blocks:
        for row, result in enumerate(results):
            for each in found:
                light = each.light.name
                errors = (
                    result.standard_errors.get(light, ""),
                    result.error_bounds.get(light, ""),
                )
                largest = each.largest
                differences = [float(values[row]) for values in (largest.delta_e_2000, largest.outer)]
                lab_range = each.box[row].ravel().tolist()
                answer: list[object] = [*result.rgb.tolist(), light, *each.lab[row].tolist()]
                writer.write([*answer, *errors, *differences, *lab_range, float(each.share[row])])


def as_table(cube: Cube, blocks: Iterable[Block], single: bool) -> None:
    """Print a line per colour and light; a single colour has its fields above."""
    for number, (results, found) in enumerate(blocks):
        if single:
            rgb = results[0].rgb
            fields = {"linear RGB": f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"}
            print_fields(fields, {"linear RGB": patch(cube, rgb)})
            emit("")
        table = make_table(
            ("hex",) * (not single) + ("light",),
            ("L* a* b*", LIKELY_TITLE, "largest", "a*", "b*", "share"),
            box=None,
            show_header=number == 0,
        )
        for row, result in enumerate(results):
            for column, each in enumerate(found):
                code = hex_code(cube, result.rgb) if column == 0 else ""
                table.add_row(*(code,) * (not single), *_cells(result.error_bounds, each, row))
        show(table)


def _cells(error_bounds: Mapping[str, float], found: Bounds, row: int) -> Iterable[str]:
    error = error_bounds.get(found.light.name)
    (_, least_a, least_b), (_, most_a, most_b) = found.box[row].tolist()
    yield found.light.name
    yield " ".join(f"{value:.1f}" for value in found.lab[row])
    yield UNKNOWN if error is None else f"{error:.2f}"
    yield f"{found.largest.delta_e_2000[row]:.2f}"
    yield f"{least_a:.0f} to {most_a:.0f}"
    yield f"{least_b:.0f} to {most_b:.0f}"
    yield f"{found.share[row]:.2g}"


BOUNDS_WRITERS: dict[str, Writer] = {"table": as_table, "json": as_json, "csv": as_csv}
