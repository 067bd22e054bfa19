"""``uplift query``: spectra of colours."""

from __future__ import annotations

import functools
import re
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import UpliftWarning

from ..colours import ColourReader, find_point
from ..inputs import find_input_space, parse_wavelengths
from ..options import (
    cube_option,
    encoded_option,
    fill_option,
    force_option,
    format_option,
    input_option,
    input_space_option,
    light_option,
    out_of_gamut_option,
    plot_option,
    stacked,
    wavelengths_option,
    xyz_options,
)
from ..output.answers import (
    coordinates,
    describe_coordinates,
    display_codes,
    format_rgb,
    hex_code,
    patch,
    print_columns,
    print_fields,
    sparkline,
)
from ..output.console import csv_writer, emit, has_colours, make_table, print_json_answers, show
from ..startup import hide_drawing_notes

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Light
    from uplift.common.arrays import Array
    from uplift.lookup import Cube, QueryResult

NEGATIVE_NUMBER = re.compile(r"-\.?\d")
LARGEST = 1e30
"""Limit of requested colours: ΔE00 of larger ones overflows."""


class ColourCommand(click.Command):
    """A command that reads '-0.1' as a number, not as an option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Mark negative numbers by a leading space before parsing."""
        return super().parse_args(ctx, [f" {arg}" if NEGATIVE_NUMBER.match(arg) else arg for arg in args])


def colour_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Argument and options of the colours of a query, and of how they are answered; for `ask`."""
    return stacked(
        click.argument("colour", nargs=-1),
        cube_option,
        input_option,
        xyz_options("Colour by XYZ under the cube's illuminant, where white has Y = 1; also outside the cube's space."),
        encoded_option,
        wavelengths_option,
        click.option(
            "--mode",
            type=click.Choice(("spectra", "moments", "refined", "nearest")),
            default="spectra",
            show_default=True,
            help="Interpolate spectra (exact), coefficients (fast), coefficients with refinement, or use the nearest "
            "node.",
        ),
        input_space_option("the colours", default="that of the cube"),
        out_of_gamut_option(),
        fill_option,
    )(function)


def ask(
    colour: tuple[str, ...],
    cube_path: str | None,
    input_path: str | None,
    xyz: tuple[float, float, float] | None,
    xy: tuple[float, float] | None,
    luminance: float | None,
    encoded: bool,
    wavelengths: str | None,
    mode: str,
    input_space: str | None,
    method: str,
    fill_missing: bool,
    lights: tuple[str, ...],
) -> tuple[QueryStream, Iterable[Sequence[QueryResult]], bool]:
    """Return answers, their blocks, and whether there is a single colour, from the values of `colour_options`."""
    from uplift.lookup import load, query_xyz

    space = find_input_space(input_space)
    point, single = find_point(colour, input_path, xyz, xy, luminance)
    cube = load(cube_path)
    at = parse_wavelengths(wavelengths)
    stream = QueryStream(cube, method, at, mode, _find_lights(lights, cube), fill_missing=fill_missing)
    if point is not None:
        return stream, [list(query_xyz(cube, [point], at, mode, stream.lights))], single
    bounded = method == "error" and input_space is None
    reader = ColourReader(cube.data.sensor, encoded=encoded, bounded=bounded, space=space)
    return stream, stream.results(reader.read(colour, input_path)), single


@click.command("query", cls=ColourCommand)
@colour_options
@light_option("Illuminant under which colour and standard error are shown", "none")
@format_option("table", "json", "csv")
@plot_option("Plot the spectra")
@force_option
def command(lights: tuple[str, ...], style: str, plot_path: str | None, force: bool, **colours: Any) -> None:
    """Query the spectrum of a COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    Numbers are linear RGB from 0 to 1 in the cube's space, or in that of --input-space. Hex colours, and numbers with
    --encoded, are encoded by the transfer function of the space.

    \b
    Examples:
      uplift query 0.8 0.2 0.1
      uplift query --cube macbeth-32.uplift '#cc3319' --plot red.png
      uplift query --encoded 204 51 25 --wavelengths 400:700:10 --format json
      uplift query --input colours.csv --format csv > spectra.csv
      uplift query 1.4 0.3 -0.1 --out-of-gamut desaturate
      uplift query --input-space P3-D65 0.2 0.9 0.3 --out-of-gamut desaturate
      uplift query --xyz 0.05 0.2 0.1
      uplift query --xy 0.17 0.7 --luminance 0.15 --format json
      echo 0.5,0.5,0.5 | uplift query - --format json
      uplift query '#cc3319' --cube macbeth-32.uplift --light FL11 --light HP1

    Standard errors are those of materials like the entries of the cube's atlas. RGB does not identify a material:
    others of the same colour may differ by more, at most as 'uplift bounds' states.

    Lines of files and of standard input are answered in blocks as they come. An error in a later block follows the
    answers to earlier ones.
    """
    from uplift.common.files import check_outputs

    check_outputs((plot_path,), inputs=(colours["cube_path"], colours["input_path"]), force=force)
    stream, results, single = ask(lights=lights, **colours)
    if plot_path is not None:
        from uplift.viz.plots import plot_spectra

        hide_drawing_notes()
        results = list(results)
        plot_spectra(stream.cube, list(chain.from_iterable(results)), plot_path, force=force)
    WRITERS[style](stream.cube, results, single)
    stream.warn()


def _find_lights(names: Sequence[str], cube: Cube) -> list[Light]:
    """Return illuminants by name at the wavelengths of a cube, each once. Raises `UnknownNameError`."""
    if not names:
        return []
    from uplift.colorimetry.observer import light

    lights = (light(name, cube.observer, *cube.data.sensor.range) for name in names)
    return list({each.name: each for each in lights}.values())


@dataclass
class QueryStream:
    """Answers to blocks of linear RGB (n, 3), and the numbers of colours that were mapped or filled."""

    cube: Cube
    method: str
    wavelengths: Array | None
    mode: str
    lights: Sequence[Light]
    fill_missing: bool
    count: int = 0
    mapped: int = 0
    filled: int = 0
    max_change: float = 0.0

    def results(self, blocks: Iterable[Array]) -> Iterator[list[QueryResult]]:
        """Answer block by block, each before the next one is read."""
        from uplift.colorimetry.gamut import map_to_gamut
        from uplift.lookup import query

        for block in blocks:
            mapped = map_to_gamut(block, self.cube.data.sensor, self.method)
            self.count += len(block)
            self.mapped += mapped.count
            self.max_change = max(self.max_change, mapped.max_change)
            if self.fill_missing:
                self.filled += int((~self.cube.covers(mapped.rgb)).sum())
                self.cube = self.cube.fill_missing(mapped.rgb)
            yield list(query(self.cube, mapped.rgb, self.wavelengths, self.mode, mapped.requested, self.lights))
            sys.stdout.flush()

    def warn(self) -> None:
        """Warn of colours that were mapped or filled."""
        if self.mapped:
            problem = (
                f"{self.mapped} of {self.count} colours lie outside [0, 1]: mapped into the gamut ({self.method}), "
                f"a component by up to {self.max_change:.3g}"
            )
            warnings.warn(UpliftWarning(problem), stacklevel=1)
        if self.filled:
            count = f"{self.filled} of {self.count} colours"
            problem = f"{count} are not in the cube's scene: filled from the packaged cube"
            warnings.warn(UpliftWarning(problem), stacklevel=1)


def _print_json(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    objects = (result_object(cube, result) for result in chain.from_iterable(blocks))
    print_json_answers(objects, single=single)


def result_object(cube: Cube, result: QueryResult) -> dict[str, Any]:
    """Return an answer as JSON values."""
    return {
        "rgb": result.rgb.tolist(),
        "requested_rgb": result.requested_rgb.tolist(),
        "wavelengths": result.wavelengths.tolist(),
        "reflectance": result.reflectance.tolist(),
        "xyz": result.xyz.tolist(),
        **coordinates(cube, result.rgb),
        "round_trip": {"rgb": result.round_trip.tolist(), "delta_e_2000": result.delta_e_2000},
        "cell": list(result.cell),
        "status": [status.label for status in result.statuses],
        "realisable": result.realisable,
        "entry": result.entry,
        "standard_error": result.standard_error,
        "error_bound": result.error_bound,
        "reference": cube.data.error_illuminant,
        "standard_errors": dict(result.standard_errors),
        "error_bounds": dict(result.error_bounds),
        "lights": {
            light: {"srgb": rgb.tolist(), "hex": code, "xyz": result.light_xyz[light].tolist()}
            for light, (rgb, code) in _light_colours(cube, result).items()
        },
        "unlike_atlas": result.unlike_atlas,
    }


def _print_csv(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    """Print a row per colour: r, g, b, round-trip ΔE00, errors, entry, reflectance at each wavelength."""
    writer = csv_writer()
    errors: list[str] = []
    for number, result in enumerate(chain.from_iterable(blocks)):
        if number == 0:
            wavelengths = [f"{wavelength:g}" for wavelength in result.wavelengths]
            names = ["", *(f"_{name}" for name in result.standard_errors)]
            errors = [f"{kind}{name}" for name in names for kind in ("standard_error", "error_bound")]
            codes = [f"hex_{name}" for name in result.light_xyz]
            writer.write(["r", "g", "b", "delta_e_2000", *errors, *codes, "entry", *wavelengths])
        expected: list[object] = [value for _, *pair in _errors(cube, result) for value in pair]
        unknown = [""] * (len(errors) - len(expected))
        codes = [code for _, code in _light_colours(cube, result).values()]
        numbers = [*result.rgb.tolist(), result.delta_e_2000]
        writer.write([*numbers, *expected, *unknown, *codes, result.entry or "", *result.reflectance.tolist()])


def _print_table(cube: Cube, blocks: Iterable[Sequence[QueryResult]], single: bool) -> None:
    """Print the fields of a single colour, or a line per colour."""
    for number, block in enumerate(blocks):
        if single:
            (result,) = block
            print_fields(_fields(cube, result), {"linear RGB": patch(cube, result.rgb)})
            emit("")
            print_columns(result.wavelengths, result.reflectance)
        else:
            _print_lines(cube, block, heading=number == 0)


def _fields(cube: Cube, result: QueryResult) -> dict[str, str]:
    """Return the fields of a single colour by name."""
    from uplift.colorimetry.delta_e import delta_e_rgb

    data, atlas, rgb = cube.data, cube.data.atlas, result.rgb
    fields = {}
    if (result.requested_rgb != rgb).any():
        moved = float(delta_e_rgb(data.sensor, result.requested_rgb.clip(-LARGEST, LARGEST), rgb))
        fields["requested"] = f"{format_rgb(result.requested_rgb)}  outside [0, 1], mapped by ΔE00 {moved:.2g}"
    fields["linear RGB"] = f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"
    fields |= describe_coordinates(cube, rgb)
    fields["cell"] = f"{result.cell} of {data.lattice.dim - 1}³, {', '.join(s.label for s in result.statuses)}"
    round_trip = f"{format_rgb(result.round_trip)}  ΔE00 {result.delta_e_2000:.2g} ({data.sensor.illuminant})"
    fields["round trip"] = round_trip
    if data.sensor.sensitivities is not None:
        fields["XYZ"] = format_rgb(result.xyz)
    if not result.realisable:
        fields["realisable"] = "no: the spectrum has less chroma, because no reflectance has this colour"
    if relit := _light_colours(cube, result):
        fields["sRGB under"] = ", ".join(f"{code} {name} ({format_rgb(lit)})" for name, (lit, code) in relit.items())
    if result.entry in atlas.names[atlas.measured_count :]:
        fields["look"] = str(result.entry)
    else:
        unknown = "none, and none is near: unlike the atlas" if result.unlike_atlas else "none"
        fields["atlas entry"] = result.entry or unknown
    if errors := _errors(cube, result):
        standard = ", ".join(f"{error:.2g} ({name})" for name, error, _ in errors)
        bound = ", ".join(f"{bound:.2g} ({name})" for name, _, bound in errors)
        fields["std. error"] = f"ΔE00 {standard} to a measured material"
        fields["error bound"] = f"ΔE00 {bound} to 95 % of them"
    else:
        fields["std. error"] = "unknown: too few atlas entries"
    wavelengths = f"{result.wavelengths[0]:g}–{result.wavelengths[-1]:g} nm"
    fields["spectrum"] = f"{sparkline(result.reflectance)}  {wavelengths}"
    return fields


def _print_lines(cube: Cube, results: Sequence[QueryResult], *, heading: bool) -> None:
    from rich.text import Text

    swatches = has_colours()
    lights = [cube.data.error_illuminant, *results[0].standard_errors] if results[0].standard_errors else []
    last = [f"± {light}" for light in lights] or ["spectrum"]
    headings = ("",) * swatches + ("hex", "linear RGB", "ΔE00", "atlas entry", *last)
    table = make_table(headings, box=None, show_header=heading)
    for result in results:
        red, green, blue = display_codes(cube, result.rgb)
        errors = [f"{error:.2f}" for _, error, _ in _errors(cube, result)]
        table.add_row(
            *(Text("   ", style=f"on rgb({red},{green},{blue})"),) * swatches,
            hex_code(cube, result.rgb),
            " ".join(f"{value:.3f}" for value in result.rgb),
            f"{result.delta_e_2000:.2g}",
            result.entry or ("unlike the atlas" if lights and result.unlike_atlas else ""),
            *(errors if lights else [sparkline(result.reflectance, 16)]),
        )
    show(table)


def _errors(cube: Cube, result: QueryResult) -> list[tuple[str, float, float]]:
    """Return light, standard error and error bound, that of the cube first; empty if they are unknown."""
    if result.standard_error is None or result.error_bound is None:
        return []
    others = [(name, error, result.error_bounds[name]) for name, error in result.standard_errors.items()]
    return [(cube.data.error_illuminant, result.standard_error, result.error_bound), *others]


def _light_colours(cube: Cube, result: QueryResult) -> dict[str, tuple[Array, str]]:
    """Return linear sRGB (3,) and '#rrggbb' of an answer by light; the white of each light is that of the screen."""
    if not result.light_xyz:
        return {}
    from uplift.colorimetry.srgb import hex_codes

    matrices = _to_srgb(tuple(result.light_xyz), cube.observer, cube.data.sensor.range)
    colours = {light: matrix @ result.light_xyz[light] for light, matrix in matrices.items()}
    return {light: (rgb, hex_codes(rgb[None])[0]) for light, rgb in colours.items()}


@functools.lru_cache(maxsize=1)
def _to_srgb(lights: tuple[str, ...], observer: str, limits: tuple[float, float, float]) -> dict[str, Array]:
    """Return the matrices (3, 3) from XYZ to linear sRGB by light."""
    from uplift.colorimetry.observer import display_sensors

    return {each.illuminant: each.xyz_to_rgb for each in display_sensors(lights, observer, *limits)}


WRITERS: dict[str, Callable[[Cube, Iterable[Sequence[QueryResult]], bool], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
"""Printers of blocks of results, each before the next one is computed."""
