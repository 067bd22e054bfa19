"""``uplift lights``: tables of the spectra of lights, of any brightness."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.files import check_output
from uplift.common.text import pluralise
from uplift.extras.export.registry import LIGHT_EXPORTS
from uplift.extras.files.outputs import check_outputs

from .. import options, sensor_options
from ..inputs import check_range
from ..output.answers import format_rgb, print_spectrum, sparkline
from ..output.console import say
from ..output.passes import print_numbers
from ..output.table import Table, print_json_rows
from ..queries import colour_sources, find_colours
from .export import Source, write_export
from .info import print_facts
from .texture import as_tuple, convert, image_options, passes_option

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.emission.lookup import EmissionTable

PACKAGED = "emission"
"""Name of the packaged table."""

table_argument = click.argument(
    "table_path", metavar="[TABLE]", required=False, default=PACKAGED, type=click.Path()
)
table_option = click.option(
    "--lights",
    "table_path",
    metavar="FILE",
    help="Emission table by 'uplift lights build'. [default: the packaged one]",
    type=click.Path(),
)


@click.group(
    "lights",
    cls=options.Group,
    help="""Give lights of any brightness the spectral powers that lamps of their colour
    are expected to have.

    Spectra of lights are in emission tables. The packaged one, named emission, is for
    linear sRGB.

    \b
    Examples:
      uplift lights query 30 22 9
      uplift lights texture sky.exr -o sky-spectral.exr --wavelengths 400:700:10
      uplift lights build -o lights.uplift
      uplift lights export -o lights.h
      uplift lights info
    """,
)
def command() -> None:
    """Hold the subcommands."""


@command.command(
    "build",
    help="""Build an emission table. Lamps of --atlas are exact at their colours; tables
    of power need no scale.

    \b
    Examples:
      uplift lights build -o lights.uplift
      uplift lights build --space ACEScg -o acescg-lights.uplift
    """,
)
@options.atlas("Spectral powers of lamps")
@options.output(help="Table to write. [default: ATLAS-emission.uplift]")
@sensor_options.space()
@sensor_options.observer()
@options.force
@options.quiet
def build(
    files: Sequence[str],
    output: str | None,
    space: str,
    observer: str,
    force: bool,
    quiet: bool,
) -> None:
    from uplift.extras.emission.build import build_emission

    stem = "+".join(Path(file).stem for file in files)
    name = f"{stem}-emission.uplift" if stem else "emission.uplift"
    path = check_output(name if output is None else output, inputs=files, force=force)
    begin = time.perf_counter()
    table = build_emission(files or None, space=space, observer=observer)
    table.save(path, force=force)
    if not quiet:
        knots, rings = table.data.lattice.shape
        say(
            f"{path}: {knots} × {rings} nodes, "
            f"{pluralise(len(table.lamp_names), 'lamp')}, expected ΔE00 of surfaces "
            f"{float(table.expected_error([1.0, 1.0, 1.0])):.1f} (white), "
            f"{path.stat().st_size / 1e6:.1f} MB, {time.perf_counter() - begin:.1f} s"
        )


@command.command(
    "info",
    help="""Show the contents of an emission table, in words or as a picture.

    \b
    Examples:
      uplift lights info
      uplift lights info --plot lights.png
      uplift lights info lights.uplift --format json

    Expected errors are ΔE00 of the ColorChecker under the light, over the nodes of the
    table.
    """,
)
@table_argument
@options.table_or_json
@options.plot("Plot colours, expected errors and lamps over u′v′")
@options.force
def info(table_path: str, style: str, plot_path: str | None, force: bool) -> None:
    from uplift.extras.emission.file import summarise
    from uplift.extras.emission.lookup import load_emission

    check_outputs((plot_path,), inputs=[table_path], force=force)
    table = load_emission(table_path)
    if plot_path is not None:
        from uplift.extras.pages.chromaticity import light_figure
        from uplift.extras.pages.figure import write_figure

        write_figure(light_figure(table), plot_path, force=force)
    print_facts(table_path, summarise(table.data), style)


@command.command(
    "export",
    help="""Write an emission table as a program that looks up colours, in C or GLSL.

    Names in the program start with the file's.

    \b
    Examples:
      uplift lights export -o lights.h
      uplift lights export lights.uplift -o mine.glsl
    """,
)
@table_argument
@options.output(help="Program to write, as .h or .glsl.", required=True)
@options.table
@options.force
def export(table_path: str, output: str, table: str | None, force: bool) -> None:
    settings = {} if table is None else {"table": table}
    inputs = [table_path]
    write_export(LIGHTS, table_path, output, None, settings, inputs=inputs, force=force)


LIGHTS = Source(LIGHT_EXPORTS, "uplift.extras.emission.lookup:load_emission")


@command.command(
    "texture",
    help="""Convert images of lights, such as environment maps, to spectral power and
    write OpenEXR textures.

    Pixels have any brightness. The unit of power is that of the equal-energy light of
    luminance 1; RGB (1, 1, 1) has luminance 1. Only colours outside the spectral locus
    change.

    \b
    Examples:
      uplift lights texture sky.exr -o sky-spectral.exr --wavelengths 400:700:10
      uplift lights texture sky.exr -o half.exr --depth half
      uplift passes choose
      uplift lights texture sky.exr -o sky --passes passes.toml
    """,
)
@image_options
@table_option
@options.output_wavelengths
@options.depth
@options.encoding
@options.input_space("the images", name="space")
@passes_option
def texture(
    table_path: str | None,
    wavelengths: Array | None,
    passes: str | None,
    **settings: Any,
) -> None:
    from uplift.extras.emission.lookup import find_table, load_emission
    from uplift.extras.texture.encodings import Spectrum

    if passes is not None:
        options.exclude("--passes", "wavelengths")
    table = None if table_path is None else os.path.abspath(find_table(table_path))
    # a table that cannot be read is reported before images are
    loaded = load_emission(table_path)
    if wavelengths is not None:
        check_range(wavelengths, loaded.wavelengths)
    encoding = Spectrum(as_tuple(wavelengths))
    convert((table,), encoding, emission=True, passes=passes, **settings)


@command.command(
    "query",
    cls=options.Command,
    everyday=("table_path", "encoded", "wavelengths", "style", "plot_path"),
    help="""Query the spectral power of a light by its COLOUR: R G B, '#rrggbb', or '-'
    for lines on standard input.

    Numbers are linear RGB of any size, negative ones included. A power of 1 at all
    wavelengths has luminance 1.

    \b
    Examples:
      uplift lights query 30 22 9
      uplift lights query 30 22 9 --wavelengths 400:700:10 --format json
      uplift lights query --xyz 0.95 1 1.09 --plot white.png
      uplift lights query 30 22 9 --passes passes.toml
    """,
)
@colour_sources("where white of the table's space has Y = 1", "that of the table")
@table_option
@options.output_wavelengths
@options.choice(
    *("--out-of-gamut", "error", "clip"),
    name="outside",
    help="Treatment of colours that no light has: raise an error, or take the nearest "
    "one towards white.",
)
@options.table_json_or_csv
@options.plot("Plot the spectra")
@click.option(
    "--passes",
    metavar="FILE",
    type=click.Path(),
    help="Passes by 'uplift passes choose': print the numbers of the lights.",
)
@options.force
def query(
    table_path: str | None,
    wavelengths: Array | None,
    outside: str,
    style: str,
    plot_path: str | None,
    passes: str | None,
    force: bool,
    **colours: Any,
) -> None:
    import numpy as np

    from uplift.colorimetry.observer import sensor
    from uplift.extras.emission.lookup import load_emission

    check_outputs((plot_path,), inputs=(table_path, colours["input_path"]), force=force)
    source = find_colours(**colours)
    table = load_emission(table_path)
    at = table.wavelengths if wavelengths is None else wavelengths
    check_range(at, table.wavelengths)
    if source.xyz:
        blocks: Iterable[Array] = [np.array([source.xyz])]
    else:
        blocks = map(table.xyz, source.blocks(sensor(table.space)))
    if passes is not None:
        options.exclude("--passes", "plot_path", "wavelengths")
        print_numbers(_pass_numbers(table, blocks, passes, outside), style)
        return
    lights: Iterable[dict[str, Any]] = _answers(table, blocks, at, outside)
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_lights

        lights = list(lights)
        spectra = [
            (np.array(light["rgb"]), at, np.array(light["power"])) for light in lights
        ]
        plot_lights(spectra, table, plot_path, force=force)
        say(f"{plot_path}: {pluralise(len(spectra), 'light')}", err=True)
    if style == "json":
        print_json_rows(lights, single=source.single)
    elif style == "csv":
        Table(map(_csv_row, lights)).print_csv()
    elif source.single:
        (light,) = lights
        _print_light(light, table.space, at, complete=wavelengths is not None)
    else:
        Table(
            lights,
            {"rgb": "linear RGB", "expected_error": "ΔE00", "power": "spectrum"},
            formats={"rgb": ".4g", "expected_error": ".2f", "power": _draw},
        ).print_text()


def _pass_numbers(
    table: EmissionTable, blocks: Iterable[Array], path: str, outside: str
) -> Iterator[tuple[list[float], list[float]]]:
    """Yield linear RGB and the numbers (K,) of passes, at least 0, of each light."""
    from uplift.colorimetry import observer
    from uplift.extras.scene.passes.file import read_passes
    from uplift.extras.scene.passes.light_images import table_projection

    projection = table_projection(read_passes(path))
    for xyz in blocks:
        power = table.spectrum_of_xyz(xyz, observer.grid(), outside=outside)
        numbers = (power @ projection.T).clip(min=0)
        rgb = table.rgb_of_xyz(xyz)
        yield from zip(rgb.tolist(), numbers.tolist(), strict=True)


def _csv_row(light: dict[str, Any]) -> dict[str, Any]:
    powers = zip(light["wavelengths"], light["power"], strict=True)
    return {
        "rgb": light["rgb"],
        "expected_error": light["expected_error"],
        **{f"{nm:g}": power for nm, power in powers},
    }


def _print_light(
    light: dict[str, Any], space: str, wavelengths: Array, *, complete: bool
) -> None:
    import numpy as np

    power = np.array(light["power"])
    fields = {
        "linear RGB": f"{format_rgb(light['rgb'])} ({space})",
        "round trip": format_rgb(light["round_trip"]["rgb"]),
        "expected error": (
            f"ΔE00 {light['expected_error']:.2g} of surfaces, to a measured lamp of "
            "this RGB"
        ),
        "peak": f"{power.max():.5g} at {wavelengths[power.argmax()]:g} nm",
    }
    highest = _peak(light["power"])
    print_spectrum(fields, wavelengths, power, complete=complete, highest=highest)


def _draw(power: list[float]) -> str:
    import numpy as np

    return sparkline(np.array(power) / _peak(power), 32)


def _answers(
    table: EmissionTable, blocks: Iterable[Array], at: Array, outside: str
) -> Iterator[dict[str, Any]]:
    """Yield the answers to blocks of XYZ (n, 3), each before the next one is read."""
    for xyz in blocks:
        answers = table.rgb(table.spectrum_of_xyz(xyz, outside=outside))
        power = table.spectrum_of_xyz(xyz, at, outside=outside)
        errors = table.expected_error(answers)
        requested = table.rgb_of_xyz(xyz)
        for rgb, answer, row, error in zip(
            requested, answers, power, errors, strict=True
        ):
            yield {
                "rgb": rgb.tolist(),
                "wavelengths": at.tolist(),
                "power": row.tolist(),
                "round_trip": {"rgb": answer.tolist()},
                "expected_error": float(error),
            }


def _peak(power: list[float]) -> float:
    """Return the largest power, for sparklines relative to it."""
    return max(*power, 1e-300)
