"""Results of ``uplift query --emission`` as table, JSON, CSV or plot."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from ..startup import hide_drawing_notes
from .console import csv_writer, emit, print_json, terminal_json
from .query_output import format_rgb, print_columns, print_fields, sparkline

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lights.lookup import EmissionTable

TREATMENTS = ("error", "clip")
"""Values of --out-of-gamut that lights have."""


@dataclass(frozen=True, eq=False)
class LightResult:
    """The answer to a light.

    Parameters
    ----------
    rgb, round_trip : ndarray, shape (3,)
        Linear RGB of the query and of the answer.
    wavelengths, power : ndarray, shape (N,)
        Wavelengths in nm and power.
    expected_error : float
        Expected ΔE00 of surfaces.
    """

    rgb: Array
    round_trip: Array
    wavelengths: Array
    power: Array
    expected_error: float


def treatment(method: str) -> str:
    """Return the treatment of colours that no light has. Raises click's error for a gamut mapping."""
    if method not in TREATMENTS:
        raise click.UsageError("--out-of-gamut is error or clip with --emission.")
    return method


def query_lights(
    table: EmissionTable, blocks: Iterable[Array], wavelengths: Array | None, outside: str
) -> Iterator[list[LightResult]]:
    """Answer blocks of XYZ (n, 3), each before the next one is read."""
    at = table.wavelengths if wavelengths is None else wavelengths
    for xyz in blocks:
        stored = table.spectrum_of_xyz(xyz, outside=outside)
        power = table.spectrum_of_xyz(xyz, at, outside=outside)
        answers = table.rgb(stored)
        errors = table.expected_error(answers)
        requested = table.rgb_of_xyz(xyz)
        yield [
            LightResult(rgb, answer, at, row, float(error))
            for rgb, answer, row, error in zip(requested, answers, power, errors, strict=True)
        ]


def write_lights(
    table: EmissionTable,
    blocks: Iterable[list[LightResult]],
    style: str,
    plot_path: str | None,
    *,
    single: bool,
    force: bool,
) -> None:
    """Print answers, and plot them."""
    if plot_path is not None:
        from uplift.viz.spectra import plot_lights

        hide_drawing_notes()
        blocks = list(blocks)
        found = list(chain.from_iterable(blocks))
        plot_lights([(each.rgb, each.wavelengths, each.power) for each in found], table, plot_path, force=force)
    results = chain.from_iterable(blocks)
    if style == "json":
        _print_json(results, single=single)
    elif style == "csv":
        _print_csv(results)
    else:
        _print_table(table, results, single=single)


def _object(result: LightResult) -> dict[str, Any]:
    return {
        "rgb": result.rgb.tolist(),
        "wavelengths": result.wavelengths.tolist(),
        "power": result.power.tolist(),
        "round_trip": {"rgb": result.round_trip.tolist()},
        "expected_error": result.expected_error,
    }


def _print_json(results: Iterable[LightResult], *, single: bool) -> None:
    if single:
        print_json(_object(next(iter(results))), indent=None)
        return
    for number, result in enumerate(results):
        emit(("[\n" if number == 0 else ",\n") + terminal_json(_object(result)), nl=False)
    emit("\n]")


def _print_csv(results: Iterable[LightResult]) -> None:
    writer = csv_writer()
    for number, result in enumerate(results):
        if number == 0:
            writer.write(["r", "g", "b", "expected_error", *(f"{each:g}" for each in result.wavelengths)])
        writer.write([*result.rgb.tolist(), result.expected_error, *result.power.tolist()])


def _print_table(table: EmissionTable, results: Iterable[LightResult], *, single: bool) -> None:
    for number, result in enumerate(results):
        shape = result.power / max(float(result.power.max()), 1e-300)
        if single:
            print_fields(
                {
                    "linear RGB": f"{format_rgb(result.rgb)} ({table.space})",
                    "round trip": format_rgb(result.round_trip),
                    "exp. error": f"ΔE00 {result.expected_error:.2g} of surfaces, to a measured lamp of this RGB",
                    "spectrum": f"{sparkline(shape)}  {result.wavelengths[0]:g}–{result.wavelengths[-1]:g} nm",
                    "peak": f"{result.power.max():.5g} at {result.wavelengths[result.power.argmax()]:g} nm",
                },
                {},
            )
            emit("")
            print_columns(result.wavelengths, result.power)
        else:
            if number == 0:
                emit(f"{'linear RGB':<34}{'ΔE00':>6}  spectrum")
            text = " ".join(f"{value:.4g}" for value in result.rgb)
            emit(f"{text:<34}{result.expected_error:>6.2f}  {sparkline(shape, 32)}")
