"""``uplift query``: spectra of colours."""

from __future__ import annotations

import functools
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import UpliftWarning
from uplift.common.text import printable

from .. import options
from ..colours import find_colours
from ..inputs import check_range
from ..output.answers import (
    coordinates,
    describe_coordinates,
    format_rgb,
    hex_code,
    patch,
    print_columns,
    sparkline,
)
from ..output.console import csv_writer, emit, has_colours, print_fields, print_json, print_json_answers, say
from ..output.diagnostics import warn
from ..startup import hide_drawing_notes

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Light
    from uplift.common.arrays import Array
    from uplift.lookup import Cube, QueryResult

PACKAGED = "packaged"
"""Name of the cube that answers without --cube."""
LARGEST = 1e30
"""Limit of requested colours: ΔE00 of larger ones overflows."""


colour_options = options.stacked(
    options.colours(
        "under the cube's illuminant, where white has Y = 1; also outside the cube's space", "that of the cube"
    ),
    options.cube,
    options.output_wavelengths,
    options.choice(
        "--mode",
        *("spectra", "moments", "refined", "nearest"),
        help="Interpolate spectra (exact), coefficients (fast), coefficients with refinement, or use the nearest node.",
    ),
    options.out_of_gamut(),
    options.fill,
)
"""Argument and options of the colours of a query, and of how they are answered; for `ask`."""


def ask(
    cube_path: str | None,
    wavelengths: Array | None,
    mode: str,
    method: str,
    fill_missing: bool,
    lights: tuple[str, ...],
    **colours: Any,
) -> tuple[QueryStream, Iterable[Sequence[QueryResult]], bool]:
    """Return answers, their blocks, and whether there is a single colour, from the values of `colour_options`."""
    from uplift.lookup import load

    source = find_colours(**colours)
    cube = load(cube_path)
    check_range(wavelengths, cube.wavelengths)
    found: list[Light] = []
    if lights:
        from uplift.colorimetry.observer import light

        lit = (light(name, cube.observer, *cube.data.sensor.range) for name in lights)
        found = list({each.name: each for each in lit}.values())
    atlases = [source["name"] for source in cube.data.provenance.get("atlases", ())]
    origin = {"file": cube_path or PACKAGED, "dim": cube.data.lattice.dim, "atlases": atlases}
    stream = QueryStream(cube, origin, method, wavelengths, mode, found, fill_missing=fill_missing)
    if source.xyz is not None:
        from uplift.lookup import query_xyz

        return stream, [list(query_xyz(cube, [source.xyz], wavelengths, mode, found))], True
    bounded = method == "error" and source.space is None
    return stream, stream.results(source.blocks(cube.data.sensor, bounded=bounded)), source.path is None


@click.command(
    "query", cls=options.Command, everyday=("cube_path", "encoded", "wavelengths", "lights", "style", "plot_path")
)
@colour_options
@options.light("Illuminant under which colour and standard error are shown", "none")
@options.output_format("table", "json", "csv")
@options.plot("Plot the spectra")
@click.option("--check", "answers", metavar="FILE", help="Compare answers that --format csv has stored; exit code 1.")
@click.option(
    "--tolerance",
    type=options.NUMBER,
    default=1e-4,
    show_default=True,
    help="Largest difference in reflectance that --check accepts.",
)
@options.force
def command(
    lights: tuple[str, ...],
    style: str,
    plot_path: str | None,
    answers: str | None,
    tolerance: float,
    force: bool,
    **colours: Any,
) -> None:
    """Query the spectrum of a COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    Numbers are linear RGB from 0 to 1 in the cube's space, or in that of --input-space. Hex colours, and numbers with
    --encoded, are encoded by the transfer function of the space.

    \b
    Examples:
      uplift query 0.8 0.2 0.1
      uplift query --cube macbeth-32.uplift '#cc3319' --plot red.png
      uplift query --encoded 204 51 25 --wavelengths 400:700:10 --format json
      uplift query --input colours.csv --format csv > spectra.csv
    \f

    \b
    More examples:
      uplift query 1.4 0.3 -0.1 --out-of-gamut desaturate
      uplift query --input-space P3-D65 0.2 0.9 0.3 --out-of-gamut desaturate
      uplift query --xyz 0.05 0.2 0.1
      uplift query --xy 0.17 0.7 --luminance 0.15 --format json
      echo 0.5,0.5,0.5 | uplift query - --format json
      uplift query '#cc3319' --cube macbeth-32.uplift --light FL11 --light HP1
      uplift query --check spectra.csv

    Standard errors are those of materials like the entries of the cube's atlas. RGB does not identify a material:
    others of the same colour may differ by more, at most as 'uplift bounds' states.

    Lines of files and of standard input are answered in blocks as they come. An error in a later block follows the
    answers to earlier ones.
    """
    if answers is not None:
        if colours["colour"] or any(colours[name] is not None for name in ("input_path", "xyz", "xy")):
            raise click.UsageError("--check takes the colours from its FILE: give no others.")
        _check(answers, colours["cube_path"], colours["mode"], tolerance, style)
        return
    if plot_path is not None:
        from uplift.common.files import check_output

        check_output(plot_path, inputs=(colours["cube_path"], colours["input_path"]), force=force)
    stream, results, single = ask(lights=lights, **colours)
    if plot_path is not None:
        from uplift.viz.plots import plot_spectra

        hide_drawing_notes()
        results = list(results)
        plot_spectra(stream.cube, list(chain.from_iterable(results)), plot_path, force=force)
    if style == "json":
        objects = (result_object(stream, each) for each in chain.from_iterable(results))
        print_json_answers(objects, single=single)
    elif style == "csv":
        _print_csv(stream.cube, chain.from_iterable(results))
    elif single:
        (result,) = chain.from_iterable(results)
        patches = {"linear RGB": patch(stream.cube, result.rgb)} if has_colours() else {}
        print_fields(_fields(stream, result), patches)
        emit("")
        print_columns(result.wavelengths, result.reflectance, complete=colours["wavelengths"] is not None)
    else:
        _print_lines(stream, chain.from_iterable(results))
    stream.warn()
    cubes = list(Path().glob("*.uplift")) if style == "table" and colours["cube_path"] is None else []
    if len(cubes) == 1:
        say(f"hint: the cube of this folder answers with --cube {cubes[0]}", err=True)


def _check(path: str, cube_path: str | None, mode: str, tolerance: float, style: str) -> None:
    """Compare stored answers with those of a cube; exit with 1 if one differs by more than the tolerance."""
    from uplift.lookup import load
    from uplift.report.answers import read_answers

    stored = read_answers(path)
    differences = stored.differences(load(cube_path), mode)
    worst = int(differences.argmax())
    passed = bool(differences[worst] <= tolerance)
    figures = {
        "answers": path,
        "colours": len(differences),
        "largest": float(differences[worst]),
        "worst_rgb": stored.rgb[worst].tolist(),
        "moved": int((differences > tolerance).sum()),
        "tolerance": tolerance,
        "passed": passed,
    }
    if style == "json":
        print_json(figures)
    else:
        verdict = "passed" if passed else "FAILED"
        say(
            f"{path}: {verdict}, {figures['moved']} of {len(differences)} answers differ by more than {tolerance:g}, "
            f"the most by {differences[worst]:.2g} ({format_rgb(stored.rgb[worst])})"
        )
    if not passed:
        raise SystemExit(1)


@dataclass
class QueryStream:
    """Answers to blocks of linear RGB (n, 3), and the numbers of colours that were mapped or filled.

    ``source`` is the cube for JSON: its file, dim and atlases.
    """

    cube: Cube
    source: dict[str, Any]
    method: str
    wavelengths: Array | None
    mode: str
    lights: Sequence[Light]
    fill_missing: bool
    count: int = 0
    mapped: int = 0
    filled: int = 0
    max_change: float = 0.0

    def describe(self) -> str:
        """Return which cube answers on one line."""
        atlases = ", ".join(self.source["atlases"]) or "no atlas"
        return f"{Path(self.source['file']).name}: {self.source['dim']}³ nodes, {atlases}"

    def results(self, blocks: Iterable[Array]) -> Iterator[list[QueryResult]]:
        """Answer block by block, each before the next one is read."""
        from uplift.lookup import query

        for requested in blocks:
            rgb = requested if self.method == "error" else self._map(requested)  # the query refuses colours outside
            self.count += len(rgb)
            if self.fill_missing:
                self.filled += int((~self.cube.covers(rgb)).sum())
                self.cube = self.cube.fill_missing(rgb)
            yield list(query(self.cube, rgb, self.wavelengths, self.mode, requested, self.lights))
            sys.stdout.flush()

    def _map(self, rgb: Array) -> Array:
        from uplift.colorimetry.gamut import map_to_gamut

        mapped = map_to_gamut(rgb, self.cube.data.sensor, self.method)
        self.mapped += mapped.count
        self.max_change = max(self.max_change, mapped.max_change)
        return mapped.rgb

    def warn(self) -> None:
        """Warn of colours that were mapped or filled."""
        if self.mapped:
            problem = (
                f"{self.mapped} of {self.count} colours lie outside [0, 1]: mapped into the gamut ({self.method}), "
                f"a component by up to {self.max_change:.3g}"
            )
            warn([UpliftWarning(problem)])
        if self.filled:
            count = f"{self.filled} of {self.count} colours"
            problem = f"{count} are not in the cube's scene: filled from the packaged cube"
            warn([UpliftWarning(problem)])


def result_object(stream: QueryStream, result: QueryResult) -> dict[str, Any]:
    """Return an answer as JSON values."""
    cube = stream.cube
    return {
        "cube": stream.source,
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


def _fields(stream: QueryStream, result: QueryResult) -> dict[str, str]:
    """Return the fields of a single colour by name."""
    from uplift.colorimetry.delta_e import delta_e_rgb

    cube = stream.cube
    data, atlas, rgb = cube.data, cube.data.atlas, result.rgb
    fields = {}
    if (result.requested_rgb != rgb).any():
        moved = float(delta_e_rgb(data.sensor, result.requested_rgb.clip(-LARGEST, LARGEST), rgb))
        fields["requested"] = f"{format_rgb(result.requested_rgb)}  outside [0, 1], mapped by ΔE00 {moved:.2g}"
    fields["linear RGB"] = f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"
    fields |= describe_coordinates(cube, rgb)
    fields["cube"] = stream.describe()
    fields["cell"] = f"{result.cell} of {data.lattice.dim - 1}³, {', '.join(s.label for s in result.statuses)}"
    round_trip = f"{format_rgb(result.round_trip)}  ΔE00 {result.delta_e_2000:.2g} ({data.sensor.illuminant})"
    fields["round trip"] = round_trip
    if data.sensor.sensitivities is not None:
        fields["XYZ"] = format_rgb(result.xyz)
    if not result.realisable:
        fields["realisable"] = "no: the spectrum has less chroma, because no reflectance has this colour"
    if result.light_xyz:
        relit = _light_colours(cube, result).items()
        fields["sRGB under"] = ", ".join(f"{code} {name} ({format_rgb(lit)})" for name, (lit, code) in relit)
    if result.entry in atlas.names[atlas.measured_count :]:
        fields["look"] = str(result.entry)
    else:
        unknown = "none, and none is near: unlike the atlas" if result.unlike_atlas else "none"
        fields["atlas entry"] = result.entry or unknown
    errors = (f"ΔE00 {error:.2g} under {name} (95 %: {bound:.2g})" for name, error, bound in _errors(cube, result))
    fields["exp. error"] = ", ".join(errors) or "unknown: too few atlas entries"
    wavelengths = f"{result.wavelengths[0]:g}–{result.wavelengths[-1]:g} nm"
    fields["spectrum"] = f"{sparkline(result.reflectance)}  {wavelengths}"
    return fields


def _print_csv(cube: Cube, results: Iterable[QueryResult]) -> None:
    """Print a row per colour: r, g, b, round-trip ΔE00, errors, entry, reflectance at each wavelength."""
    writer = csv_writer()
    columns: list[str] = []
    for result in results:
        cells = dict(zip("rgb", result.rgb.tolist(), strict=True)) | {"delta_e_2000": result.delta_e_2000}
        cells |= {"standard_error": result.standard_error, "error_bound": result.error_bound}
        for light, error in result.standard_errors.items():
            cells |= {f"standard_error_{light}": error, f"error_bound_{light}": result.error_bounds[light]}
        cells |= {f"hex_{light}": code for light, (_, code) in _light_colours(cube, result).items()}
        cells["entry"] = result.entry
        if not columns:
            columns = list(cells)
            writer.write([*columns, *(f"{wavelength:g}" for wavelength in result.wavelengths)])
        writer.write([*map(cells.get, columns), *result.reflectance.tolist()])


def _print_lines(stream: QueryStream, results: Iterable[QueryResult]) -> None:
    """Print the cube, a heading, and a line per colour; the entry, of any length, comes last."""
    for number, result in enumerate(results):
        cube = stream.cube
        errors = {f"± {light}": f"{error:.2f}" for light, error, _ in _errors(cube, result)}
        if number == 0:
            names = list(errors) or [f"{'spectrum':<16}"]
            swatch = " " * 5 * has_colours()
            say(f"cube     {stream.describe()}")
            say(f"{swatch}hex      {'linear RGB':<17}  {'ΔE00':<7}  {'  '.join(names)}  atlas entry")
        last = [f"{error:>{len(name)}}" for name, error in errors.items()] or [sparkline(result.reflectance, 16)]
        rgb = " ".join(f"{value:.3f}" for value in result.rgb)
        entry = result.entry or ("unlike the atlas" if errors and result.unlike_atlas else "")
        line = f"{hex_code(cube, result.rgb)}  {rgb}  {result.delta_e_2000:<7.2g}  {'  '.join(last)}  {entry}"
        emit((f"{patch(cube, result.rgb, 3)}  " if has_colours() else "") + printable(line.rstrip()))


def _errors(cube: Cube, result: QueryResult) -> list[tuple[str, float, float]]:
    """Return light, standard error and error bound, that of the cube first; empty if they are unknown."""
    if result.standard_error is None or result.error_bound is None:
        return []
    reference = cube.data.error_illuminant
    others = [(name, x, result.error_bounds[name]) for name, x in result.standard_errors.items() if name != reference]
    return [(reference, result.standard_error, result.error_bound), *others]


def _light_colours(cube: Cube, result: QueryResult) -> dict[str, tuple[Array, str]]:
    """Return linear sRGB (3,) and '#rrggbb' of an answer by light; the white of each light is that of the screen."""
    from uplift.colorimetry.srgb import hex_codes

    to_srgb = functools.partial(_to_srgb, cube.observer, cube.data.sensor.range)
    colours = {light: to_srgb(light) @ xyz for light, xyz in result.light_xyz.items()}
    return {light: (rgb, hex_codes(rgb[None])[0]) for light, rgb in colours.items()}


@functools.cache
def _to_srgb(observer: str, limits: tuple[float, float, float], light: str) -> Array:
    """Return the matrix (3, 3) from XYZ under a light to linear sRGB."""
    from uplift.colorimetry.observer import display_sensors

    return display_sensors((light,), observer, *limits)[0].xyz_to_rgb
