"""``uplift query``: spectra of colours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import also as further
from .. import options
from ..output.answers import format_rgb
from ..output.console import paragraph, print_json, say
from ..output.passes import print_numbers
from ..output.query import print_answers
from ..outputs import check_outputs
from ..queries import Answers, colour_options

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.colour.query import QueryBlock


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
        "details",
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
      uplift query '#cc3319' --details
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
    as 'uplift lab bounds' states.

    Lines of files and of standard input are answered in blocks as they come. An error
    in a later block follows the answers to earlier ones.
    """,
)
@colour_options
@further.also(
    "COLOUR", further.is_colour, "Colour of the same thing under another light"
)
@further.noise
@further.balance
@options.light("Illuminant under which colour and standard error are shown", "none")
@options.table_json_or_csv
@options.flag(
    "--details",
    help="Print also the cube, the cell, hue, HSV, HSL and YIQ, and the round trip of "
    "one colour. JSON has them always.",
)
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
    details: bool,
    plot_path: str | None,
    stored: str | None,
    tolerance: float,
    passes: str | None,
    force: bool,
    **colours: Any,
) -> None:
    if passes is not None:
        options.exclude("--passes", "lights", "plot_path", "wavelengths", "stored")
        print_numbers(_pass_numbers(passes, colours), style)
        return
    if stored is not None:
        options.exclude("--check", "colour", "input_path", "xyz", "xy")
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
        plot_spectra(answers.cube, blocks, plot_path, force=force)
        count = sum(map(len, blocks))
        say(f"{plot_path}: {pluralise(count, 'colour')}", err=True)
    print_answers(answers, blocks, style, details=details)
    if style == "table" and colours["cube_path"] is None:
        _suggest_cube()


def _suggest_cube() -> None:
    """Name the cube of the folder if there is one."""
    cubes = list(Path().glob("*.uplift"))
    if len(cubes) == 1:
        hint = f"to use the cube of this folder, add --cube {cubes[0]}"
        paragraph(f"hint: {hint}", err=True)


def _pass_numbers(
    path: str, colours: dict[str, Any]
) -> Iterator[tuple[list[float], list[float]]]:
    """Yield linear RGB and the numbers (K,) of passes of each colour."""
    from uplift.colorimetry import observer
    from uplift.extras.scene.passes.file import read_passes
    from uplift.extras.scene.passes.textures import check_cube

    passes = read_passes(path)
    answers = Answers(lights=(), **colours | {"wavelengths": observer.grid()})
    check_cube(passes, answers.cube)
    for block in answers:
        numbers = passes.reflectance_numbers(block.reflectance)
        yield from zip(block.rgb.tolist(), numbers.tolist(), strict=True)


def _check(
    path: str, cube_path: str | None, mode: str, tolerance: float, style: str
) -> None:
    """Compare stored answers with those of a cube; exit with 1 if one differs by more
    than the tolerance.
    """
    from uplift.extras.report.answers import read_answers
    from uplift.lookup.cube import load

    stored = read_answers(path)
    differences = stored.differences(load(cube_path), mode)
    worst = int(differences.argmax())
    largest = float(differences[worst])
    rgb = stored.rgb[worst]
    moved = int((differences > tolerance).sum())
    passed = largest <= tolerance
    if style == "json":
        print_json(
            {
                "answers": path,
                "colours": len(differences),
                "largest": largest,
                "worst_rgb": rgb.tolist(),
                "moved": moved,
                "tolerance": tolerance,
                "passed": passed,
            }
        )
    else:
        say(
            f"{path}: {'passed' if passed else 'FAILED'}, {moved} of "
            f"{pluralise(len(differences), 'answer')} moved by more than "
            f"{tolerance:g}, the most by {largest:.2g} ({format_rgb(rgb)})"
        )
    if not passed:
        raise SystemExit(1)
