"""``uplift lights``: tables of the spectra of lights, of any brightness."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import options
from ..colours import find_colours
from ..output.answers import format_rgb, print_columns, sparkline
from ..output.console import csv_writer, emit, print_fields, print_json_answers, say
from .info import print_facts
from .texture import as_tuple, convert, image_options

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.lights.lookup import EmissionTable

PACKAGED = "emission"
"""Name of the packaged table."""
LANGUAGES = {".h": "c", ".glsl": "glsl"}
"""Languages of `uplift.io.export.write_light_program` by suffix."""

table_argument = click.argument("table_path", metavar="[TABLE]", required=False, default=PACKAGED, type=click.Path())
table_option = click.option(
    "--lights",
    "table_path",
    metavar="FILE",
    help="Emission table by 'uplift lights build'. [default: the packaged one]",
    type=click.Path(),
)


@click.group("lights")
def command() -> None:
    """Give lights of any brightness the spectral powers that lamps of their colour are expected to have.

    Spectra of lights are in emission tables. The packaged one, named emission, is for linear sRGB.

    \b
    Examples:
      uplift lights query 30 22 9
      uplift lights texture sky.exr -o sky-spectral.exr --wavelengths 400:700:10
      uplift lights build -o lights.uplift
      uplift lights export -o lights.h
      uplift lights info
    """


@command.command("build")
@options.atlas("Spectral powers of lamps")
@click.option("-o", "--output", metavar="FILE", help="Table to write. [default: ATLAS-emission.uplift]")
@click.option(
    "--space",
    default="sRGB",
    help="RGB space of queries by its name in colour-science or OpenColorIO, such as ACEScg.",
    shell_complete=options.complete_space,
)
@click.option("--observer", help="Standard observer. [default: CIE 1931 2 Degree Standard Observer]")
@options.force
@options.quiet
def build(
    files: tuple[str, ...], output: str | None, space: str, observer: str | None, force: bool, quiet: bool
) -> None:
    """Build an emission table. Lamps of --atlas are exact at their colours; tables of power need no scale.

    \b
    Examples:
      uplift lights build -o lights.uplift
      uplift lights build --space ACEScg -o acescg-lights.uplift
    """
    from uplift.colorimetry.observer import DEFAULT_OBSERVER
    from uplift.common.files import check_output
    from uplift.lights.build import build_emission

    stem = "+".join(Path(file).stem for file in files)
    name = f"{stem}-emission.uplift" if stem else "emission.uplift"
    path = check_output(name if output is None else output, inputs=files, force=force)
    begin = time.perf_counter()
    table = build_emission(files or None, space=space, observer=observer or DEFAULT_OBSERVER)
    table.save(path, force=force)
    if not quiet:
        knots, rings = table.data.lattice.shape
        say(
            f"{path}: {knots} × {rings} nodes, {len(table.lamp_names)} lamps, "
            f"expected ΔE00 of surfaces {float(table.expected_error([1.0, 1.0, 1.0])):.1f} (white), "
            f"{path.stat().st_size / 1e6:.1f} MB, {time.perf_counter() - begin:.1f} s"
        )


@command.command("info")
@table_argument
@options.output_format("table", "json")
@options.plot("Plot colours, expected errors and lamps over u′v′")
@click.option("--html", metavar="FILE", help="Page with the plots, answers to random lights, and all lamps.")
@options.force
def info(table_path: str, style: str, plot_path: str | None, html: str | None, force: bool) -> None:
    """Show the contents of an emission table, in words, as a picture or as a page.

    \b
    Examples:
      uplift lights info
      uplift lights info --plot lights.png --html lights.html
      uplift lights info lights.uplift --format json
    """
    from uplift.common.files import check_outputs, write_text
    from uplift.lights.lookup import find_table, load_emission
    from uplift.lights.table import summarise

    check_outputs((plot_path, html), inputs=[table_path], force=force)
    table = load_emission(table_path)
    if plot_path is not None:
        from uplift.viz.chromaticity import light_figure
        from uplift.viz.figure import write_figure

        write_figure(light_figure(table), plot_path, force=force)
    if html is not None:
        from uplift.report.lights import render_light_report

        file = Path(find_table(table_path))
        write_text(render_light_report(table, file.name, file.stat().st_size), html, force=force)
    print_facts(table_path, summarise(table.data), style)


@command.command("export")
@table_argument
@click.option("-o", "--output", metavar="FILE", required=True, help="Program to write, as .h or .glsl.")
@click.option(
    "--table",
    "form",
    type=click.Choice(("header", "file")),
    help="Where the numbers of the program are. [default: header for .h, else file]",
)
@options.force
def export(table_path: str, output: str, form: str | None, force: bool) -> None:
    """Write an emission table as a program that looks up colours, in C or GLSL.

    Names in the program start with the file's.

    \b
    Examples:
      uplift lights export -o lights.h
      uplift lights export lights.uplift -o mine.glsl
    """
    from uplift.common.files import check_output
    from uplift.io.export import write_light_program
    from uplift.lights.lookup import load_emission

    language = LANGUAGES.get(Path(output).suffix.lower())
    if language is None:
        raise click.UsageError(f"--output must end in {' or '.join(LANGUAGES)}.")
    path = check_output(output, inputs=[table_path], force=force)
    data = load_emission(table_path).data
    written = write_light_program(data, path, style=language, form=form, force=force)
    size = sum(each.stat().st_size for each in written) / 1e6
    tables = "".join(f", table in {each}" for each in written[1:])
    knots, rings = data.lattice.shape
    say(f"{path}: {knots * rings} nodes, {len(data.entries.names)} lamps, {size:.1f} MB{tables}")


@command.command("texture")
@image_options
@table_option
@options.output_wavelengths
@click.option("--depth", type=click.Choice(("float", "half")), help="32 or 16 bits per channel. [default: float]")
@options.encoding("the images")
@options.input_space("the images", name="space")
def texture(table_path: str | None, wavelengths: Array | None, **settings: Any) -> None:
    """Convert images of lights, such as environment maps, to spectral power and write OpenEXR textures.

    Pixels have any brightness. The unit of power is that of the equal-energy light of luminance 1; RGB (1, 1, 1) has
    luminance 1. Only colours outside the spectral locus change.

    \b
    Examples:
      uplift lights texture sky.exr -o sky-spectral.exr --wavelengths 400:700:10
      uplift lights texture sky.exr -o half.exr --depth half
    """
    from uplift.io.texture import Spectrum
    from uplift.lights.lookup import find_table

    table = None if table_path is None else os.path.abspath(find_table(table_path))
    convert((table,), Spectrum(as_tuple(wavelengths)), emission=True, **settings)


@command.command("query", cls=options.Command, everyday=("table_path", "encoded", "wavelengths", "style", "plot_path"))
@options.colours("where white of the table's space has Y = 1", "that of the table")
@table_option
@options.output_wavelengths
@click.option(
    "--out-of-gamut",
    "outside",
    type=click.Choice(("error", "clip")),
    default="error",
    help="Treatment of colours that no light has: raise an error, or take the nearest one towards white.",
)
@options.output_format("table", "json", "csv")
@options.plot("Plot the spectra")
@options.force
def query(
    table_path: str | None,
    wavelengths: Array | None,
    outside: str,
    style: str,
    plot_path: str | None,
    force: bool,
    **colours: Any,
) -> None:
    """Query the spectral power of a light by its COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    Numbers are linear RGB of any size, negative ones included. A power of 1 at all wavelengths has luminance 1.

    \b
    Examples:
      uplift lights query 30 22 9
      uplift lights query 30 22 9 --wavelengths 400:700:10 --format json
      uplift lights query --xyz 0.95 1 1.09 --plot white.png
    """
    import numpy as np

    from uplift.colorimetry.observer import sensor
    from uplift.common.files import check_outputs
    from uplift.lights.lookup import load_emission

    check_outputs((plot_path,), inputs=(table_path, colours["input_path"]), force=force)
    source = find_colours(**colours)
    table = load_emission(table_path)
    blocks = [np.array([source.xyz])] if source.xyz else map(table.xyz, source.blocks(sensor(table.space)))
    results = _answers(table, blocks, table.wavelengths if wavelengths is None else wavelengths, outside)
    if plot_path is not None:
        from uplift.viz.plots import plot_lights

        found = list(results)
        plot_lights([(each.rgb, each.wavelengths, each.power) for each in found], table, plot_path, force=force)
        results = iter(found)
    if style == "json":
        print_json_answers((result.to_json() for result in results), single=source.path is None)
    elif style == "csv":
        _print_csv(results)
    elif source.path is None:
        _print_details(table, next(results), complete=wavelengths is not None)
    else:
        _print_lines(results)


@dataclass(frozen=True, eq=False)
class LightAnswer:
    """Linear RGB of a query and of the answer, its power (N,) at wavelengths in nm, and expected ΔE00 of surfaces."""

    rgb: Array
    round_trip: Array
    wavelengths: Array
    power: Array
    expected_error: float

    def to_json(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "rgb": self.rgb.tolist(),
            "wavelengths": self.wavelengths.tolist(),
            "power": self.power.tolist(),
            "round_trip": {"rgb": self.round_trip.tolist()},
            "expected_error": self.expected_error,
        }


def _answers(table: EmissionTable, blocks: Iterable[Array], at: Array, outside: str) -> Iterator[LightAnswer]:
    """Answer blocks of XYZ (n, 3), each before the next one is read."""
    for xyz in blocks:
        stored = table.spectrum_of_xyz(xyz, outside=outside)
        power = table.spectrum_of_xyz(xyz, at, outside=outside)
        answers = table.rgb(stored)
        errors = table.expected_error(answers)
        requested = table.rgb_of_xyz(xyz)
        for rgb, answer, row, error in zip(requested, answers, power, errors, strict=True):
            yield LightAnswer(rgb, answer, at, row, float(error))


def _print_csv(results: Iterable[LightAnswer]) -> None:
    writer = csv_writer()
    for number, result in enumerate(results):
        if number == 0:
            writer.write(["r", "g", "b", "expected_error", *(f"{each:g}" for each in result.wavelengths)])
        writer.write([*result.rgb.tolist(), result.expected_error, *result.power.tolist()])


def _print_details(table: EmissionTable, result: LightAnswer, *, complete: bool) -> None:
    at = result.wavelengths
    fields = {
        "linear RGB": f"{format_rgb(result.rgb)} ({table.space})",
        "round trip": format_rgb(result.round_trip),
        "exp. error": f"ΔE00 {result.expected_error:.2g} of surfaces, to a measured lamp of this RGB",
        "spectrum": f"{_shape(result)}  {at[0]:g}–{at[-1]:g} nm",
        "peak": f"{result.power.max():.5g} at {at[result.power.argmax()]:g} nm",
    }
    print_fields(fields)
    emit("")
    print_columns(at, result.power, complete=complete)


def _print_lines(results: Iterable[LightAnswer]) -> None:
    for number, result in enumerate(results):
        if number == 0:
            emit(f"{'linear RGB':<34}{'ΔE00':>6}  spectrum")
        text = " ".join(f"{value:.4g}" for value in result.rgb)
        emit(f"{text:<34}{result.expected_error:>6.2f}  {_shape(result, 32)}")


def _shape(result: LightAnswer, width: int = 40) -> str:
    """The spectrum relative to its peak as block characters."""
    return sparkline(result.power / max(float(result.power.max()), 1e-300), width)
