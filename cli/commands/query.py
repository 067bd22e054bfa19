"""``uplift query``: spectra of colours."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import UpliftWarning
from uplift.common.text import pluralise

from .. import also as further
from .. import options
from ..colours import find_colours, is_colour
from ..inputs import check_range
from ..output.answers import (
    coordinates,
    describe_coordinates,
    format_rgb,
    hex_code,
    patch,
    print_spectrum,
)
from ..output.console import (
    paragraph,
    print_csv,
    print_json,
    print_json_answers,
    say,
)
from ..output.diagnostics import warn
from ..output.query_blocks import json_objects, print_csv_answers, print_table
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry import Light
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.colour.query import QueryBlock, QueryResult
    from uplift.extras.photographs import PhotographedColour
    from uplift.lookup import Cube

PACKAGED = "packaged"
"""Name of the cube that answers without --cube."""
NO_ERROR = "unknown; a cube that is built again states it"
"""In place of an error, for cubes without left-out materials."""
FAMILIES = "among materials of unknown families"
"""What the errors of a cube hold for that are learnt from families, and not from an
atlas.
"""
LARGEST = 1e30
"""Limit of requested colours: ΔE00 of larger ones overflows."""


colour_options = options.stacked(
    options.colours(
        "under the cube's illuminant, where white has Y = 1; also outside the cube's "
        "space",
        "that of the cube",
    ),
    options.cube(),
    options.output_wavelengths,
    options.choice(
        "--mode",
        *("spectra", "moments", "refined", "nearest"),
        help="Interpolate spectra (exact), coefficients (fast), coefficients with "
        "refinement, or use the nearest node.",
    ),
    options.out_of_gamut("error", "as such a number is often a mistake"),
    options.fill,
)
"""Argument and options of the colours of a query, and of how they are answered; for
`Answers`.
"""


class Answers:
    """Answers to blocks of colours from the values of `colour_options`, each before the
    next block is read.

    ``cube`` is filled where colours need it. ``origin`` is its file, dim and atlases,
    for JSON, and ``title`` for text.
    """

    def __init__(
        self,
        cube_path: str | None,
        wavelengths: Array | None,
        mode: str,
        method: str,
        fill_missing: bool,
        lights: Sequence[Illuminant],
        **colours: Any,
    ) -> None:
        from uplift.lookup import load

        self.source = find_colours(**colours)
        self.single = self.source.single
        self.cube = load(cube_path)
        if wavelengths is not None:
            check_range(wavelengths, self.cube.wavelengths)
        self.wavelengths = wavelengths
        self.mode = mode
        self.method = method
        self.fill_missing = fill_missing
        data = self.cube.data
        atlases = [source["name"] for source in data.provenance.get("atlases", ())]
        file = cube_path or PACKAGED
        dim = data.lattice.dim
        self.origin = {"file": file, "dim": dim, "atlases": atlases}
        self.further: PhotographedColour | None = None
        self.title = (
            f"{Path(file).name}: {dim}³ nodes, {', '.join(atlases) or 'no atlas'}"
        )
        self.lights: list[Light] = []
        # matrices from XYZ under a light to linear sRGB with the same white
        self.to_srgb: dict[str, Array] = {}
        if lights:
            from uplift.colorimetry.observer import display_sensors, light

            setting = self.cube.observer, *data.sensor.range
            for display in display_sensors(lights, *setting):
                self.to_srgb[display.illuminant] = display.xyz_to_rgb
            lit = [light(illuminant, *setting) for illuminant in lights]
            self.lights = list({light.name: light for light in lit}.values())

    def __iter__(self) -> Iterator[QueryBlock]:
        """Answer blocks, and warn at the end of colours that were mapped or filled."""
        from uplift.extras.colour.query import locate_xyz, query_blocks

        how = (self.wavelengths, self.mode)
        if self.source.xyz is not None:
            rgb, requested, outside = locate_xyz(self.cube, [self.source.xyz])
            yield from query_blocks(
                self.cube, rgb, *how, requested, self.lights, outside
            )
            return
        count = mapped = filled = 0
        change = 0.0
        bounded = self.method == "error" and self.source.space is None
        for requested in self.source.blocks(self.cube.data.sensor, bounded=bounded):
            rgb = requested  # which the query refuses outside [0, 1]
            if self.method != "error":
                from uplift.colorimetry.gamut import map_to_gamut

                inside = map_to_gamut(requested, self.cube.data.sensor, self.method)
                rgb = inside.rgb
                mapped += inside.count
                change = max(change, inside.max_change)
            count += len(rgb)
            if self.fill_missing:
                filled += int((~self.cube.covers(rgb)).sum())
                self.cube = self.cube.fill_missing(rgb)
            blocks = query_blocks(
                self.cube,
                rgb,
                *how,
                requested,
                self.lights,
                answering=self.further,
            )
            for block in blocks:
                yield block
                sys.stdout.flush()
        if mapped:
            by = (
                f"mapped into the gamut ({self.method}), a component by up to "
                f"{change:.3g}"
            )
            problem = f"{mapped} of {pluralise(count, 'colour')} outside [0, 1]: {by}"
            warn([UpliftWarning(problem)])
        if filled:
            problem = (
                f"{filled} of {pluralise(count, 'colour')} outside the cube's scene: "
                "filled from the packaged cube"
            )
            warn([UpliftWarning(problem)])

    def light_colours(
        self, answers: QueryBlock | QueryResult
    ) -> dict[str, tuple[Array, list[str]]]:
        """Return linear sRGB (n, 3) and '#rrggbb' (n,) of n answers, or of one, by
        light; its white is that of the screen.
        """
        from uplift.extras.colour.srgb import hex_codes

        colours = {}
        for light, xyz in answers.light_xyz.items():
            rgb = (self.to_srgb[light] @ xyz.reshape(-1, 3, 1))[..., 0]
            colours[light] = rgb, hex_codes(rgb)
        return colours


@click.command(
    "query",
    cls=options.Command,
    everyday=(
        "cube_path",
        "encoded",
        "wavelengths",
        "lights",
        "also",
        "style",
        "plot_path",
    ),
    help="""Query the spectra of colours: R G B, '#rrggbb', or '-' for lines on standard
    input.

    Numbers are linear RGB from 0 to 1 in the cube's space, or in that of --input-space.
    Hex colours, and numbers with --encoded, are encoded by the transfer function of the
    space.

    \b
    Examples:
      uplift query 0.8 0.2 0.1
      uplift query '#da7b2a' '#3366cc' --plot
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
      uplift query '#cc3319' --light lamp.spd
      uplift query '#8a2a20' --also A:'#9a3020'
      uplift query --check spectra.csv
      uplift passes choose
      uplift query '#cc3319' '#3366cc' --passes passes.toml

    With --also, the colour of the same thing under another light shows which of the
    materials of one colour it is; white is white there, as in the pictures of 'uplift
    relight', unless --balance is none.

    Standard errors are those of materials like the entries of the cube's atlas. RGB
    does not identify a material: others of the same colour may differ by more, at most
    as 'uplift bounds' states.

    Lines of files and of standard input are answered in blocks as they come. An error
    in a later block follows the answers to earlier ones.
    """,
)
@colour_options
@further.also("COLOUR", is_colour, "Colour of the same thing under another light")
@further.noise
@further.balance
@options.light("Illuminant under which colour and standard error are shown", "none")
@options.table_json_or_csv
@options.plot("Plot the spectra")
@click.option(
    "--check",
    "stored",
    metavar="FILE",
    help="Compare answers that --format csv has stored; exit code 1.",
)
@options.number(
    "--tolerance",
    default=1e-4,
    help="Largest difference in reflectance that --check accepts.",
)
@click.option(
    "--passes",
    metavar="FILE",
    type=click.Path(),
    help="Passes by 'uplift passes choose': print the numbers of the colours in each.",
)
@options.force
def command(
    lights: Sequence[Illuminant],
    also: Sequence[further.Further],
    noise: tuple[float, float] | None,
    balance: str,
    style: str,
    plot_path: str | None,
    stored: str | None,
    tolerance: float,
    passes: str | None,
    force: bool,
    **colours: Any,
) -> None:
    if passes is not None:
        _check_passes()
        print_numbers(_pass_numbers(passes, colours), style)
        return
    if stored is not None:
        given = [colours[name] for name in ("colour", "input_path", "xyz", "xy")]
        if given != [(), None, None, None]:
            raise click.UsageError(
                "--check takes the colours from its FILE: give no others."
            )
        _check(stored, colours["cube_path"], colours["mode"], tolerance, style)
        return
    check_outputs(plot_path)
    answers = Answers(lights=lights, **colours)
    if also:
        answers.further = further.photographed_colour(
            answers.cube, answers.source, also, noise, balance
        )
    blocks: Iterable[QueryBlock] = answers
    if plot_path is not None:
        from uplift.extras.pages.plots import plot_spectra

        blocks = list(blocks)
        results = list(chain.from_iterable(blocks))
        plot_spectra(answers.cube, results, plot_path, force=force)
        say(f"{plot_path}: {pluralise(len(results), 'colour')}", err=True)
    if style == "json":
        texts = map(partial(json_objects, answers), blocks)
        print_json_answers(texts, single=answers.single)
    elif style == "csv":
        print_csv_answers(answers, blocks)
    elif answers.single:
        (result,) = chain.from_iterable(blocks)
        print_spectrum(
            _fields(answers, result),
            result.wavelengths,
            result.reflectance,
            complete=colours["wavelengths"] is not None,
            patches={"linear RGB": patch(answers.cube, result.rgb)},
        )
    else:
        print_table(answers, blocks)
    if style == "table" and colours["cube_path"] is None:
        cubes = list(Path().glob("*.uplift"))
        if len(cubes) == 1:
            hint = f"to use the cube of this folder, add --cube {cubes[0]}"
            paragraph(f"hint: {hint}", err=True)


def _check_passes() -> None:
    """Raise a usage error for options that numbers of passes do not have."""
    given = options.given()
    for name in ("lights", "plot_path", "wavelengths", "stored"):
        if name in given:
            raise click.UsageError(f"--passes excludes {given[name]}.")


def _pass_numbers(
    path: str, colours: dict[str, Any]
) -> Iterator[tuple[list[float], list[float]]]:
    """Yield linear RGB and the numbers (K,) of passes of each colour."""
    from uplift.colorimetry import observer
    from uplift.extras.scene.passes import check_cube, read_passes

    passes = read_passes(path)
    answers = Answers(lights=(), **colours | {"wavelengths": observer.grid()})
    check_cube(passes, answers.cube)
    for block in answers:
        numbers = passes.reflectance_numbers(block.reflectance)
        yield from zip(block.rgb.tolist(), numbers.tolist(), strict=True)


def print_numbers(rows: Iterable[tuple[list[float], list[float]]], style: str) -> None:
    """Print the numbers (K,) of passes of colours, three for each pass."""
    if style == "csv":
        print_csv(("r", "g", "b", "pass", "R", "G", "B"), _pass_rows(rows))
        return
    if style == "json":
        values = [
            {"rgb": rgb, "passes": [list(row) for row in _triples(numbers)]}
            for rgb, numbers in rows
        ]
        print_json(values)
        return
    for rgb, numbers in rows:
        say(f"linear RGB {format_rgb(rgb)}")
        for number, triple in enumerate(_triples(numbers), 1):
            say(f"  pass {number}: {' '.join(map('{:.6g}'.format, triple))}")


def _triples(numbers: list[float]) -> list[list[float]]:
    return [numbers[first : first + 3] for first in range(0, len(numbers), 3)]


def _pass_rows(
    rows: Iterable[tuple[list[float], list[float]]],
) -> Iterator[list[float]]:
    for rgb, numbers in rows:
        for number, triple in enumerate(_triples(numbers), 1):
            yield [*rgb, number, *triple]


def _check(
    path: str, cube_path: str | None, mode: str, tolerance: float, style: str
) -> None:
    """Compare stored answers with those of a cube; exit with 1 if one differs by more
    than the tolerance.
    """
    from uplift.extras.report.answers import read_answers
    from uplift.lookup import load

    stored = read_answers(path)
    differences = stored.differences(load(cube_path), mode)
    worst = int(differences.argmax())
    passed = bool(differences[worst] <= tolerance)
    moved = int((differences > tolerance).sum())
    if style == "json":
        figures = {
            "largest": float(differences[worst]),
            "worst_rgb": stored.rgb[worst].tolist(),
            "moved": moved,
        }
        counts = {"answers": path, "colours": len(differences)}
        print_json(counts | figures | {"tolerance": tolerance, "passed": passed})
    else:
        say(
            f"{path}: {'passed' if passed else 'FAILED'}, {moved} of "
            f"{pluralise(len(differences), 'answer')} "
            f"moved by more than {tolerance:g}, the most by {differences[worst]:.2g} "
            f"({format_rgb(stored.rgb[worst])})"
        )
    if not passed:
        raise SystemExit(1)


def _fields(answers: Answers, result: QueryResult) -> dict[str, str]:
    from uplift.colorimetry import delta_e_rgb
    from uplift.colorimetry.sensor import SLACK

    cube = answers.cube
    data = cube.data
    atlas = cube.data.atlas
    rgb = result.rgb
    fields = {}
    if (abs(result.requested_rgb - rgb) > 2 * SLACK).any():
        moved = float(
            delta_e_rgb(data.sensor, result.requested_rgb.clip(-LARGEST, LARGEST), rgb)
        )
        fields["requested"] = (
            f"{format_rgb(result.requested_rgb)}  outside [0, 1], mapped by ΔE00 "
            f"{moved:.2g}"
        )
    fields["linear RGB"] = f"{format_rgb(rgb)}  {hex_code(cube, rgb)}"
    fields |= describe_coordinates(coordinates(cube, rgb))
    fields["cube"] = answers.title
    fields["cell"] = (
        f"{result.cell} of {data.lattice.dim - 1}³, "
        f"{', '.join(s.label for s in result.statuses)}"
    )
    round_trip = (
        f"{format_rgb(result.round_trip)}  ΔE00 {result.delta_e_2000:.2g} "
        f"({data.sensor.illuminant})"
    )
    fields["round trip"] = round_trip
    if answers.further is not None:
        fields["also under"] = _describe_further(answers.further, result.rgb)
    if data.sensor.sensitivities is not None:
        fields["XYZ"] = format_rgb(result.xyz)
    if not result.realisable:
        fields["realisable"] = (
            "no: the spectrum has less chroma, because no reflectance has this colour"
        )
    if result.light_xyz:
        relit = answers.light_colours(result).items()
        fields["sRGB under"] = ", ".join(
            f"{name}: {code} ({format_rgb(lit)})" for name, ([lit], [code]) in relit
        )
    if result.entry is None:
        is_far = result.unlike_atlas and data.families is None
        fields["atlas entry"] = (
            "none, and none is near: unlike the atlas" if is_far else "none"
        )
    else:
        is_look = result.entry in atlas.names[atlas.measured_count :]
        fields["look" if is_look else "atlas entry"] = result.entry
    errors = (
        f"ΔE00 {error:.2g} under {name} (95 %: {bound:.2g})"
        for name, error, bound in _errors(cube, result)
    )
    stated = [*errors, *([FAMILIES] if data.families is not None else [])]
    fields["expected error"] = ", ".join(stated) or NO_ERROR
    return fields


def _describe_further(further: PhotographedColour, rgb: Array) -> str:
    """Describe a colour (3,) under other lights."""
    names = [photograph.light for photograph in further.photographs.further]
    if further.contradicts(rgb[None]):
        return f"{', '.join(names)}: contradicts the colour, and is not used"
    parts = [
        f"{name}: {format_rgb(values)}"
        for name, values in zip(names, further.others.reshape(-1, 3), strict=True)
    ]
    return ", ".join(parts)


def _errors(cube: Cube, result: QueryResult) -> list[tuple[str, float, float]]:
    """Return light, standard error and error bound, that of the cube first; empty if
    they are unknown.
    """
    if result.standard_error is None or result.error_bound is None:
        return []
    reference = cube.data.error_illuminant
    others = [
        (name, x, result.error_bounds[name])
        for name, x in result.standard_errors.items()
        if name != reference
    ]
    return [(reference, result.standard_error, result.error_bound), *others]
