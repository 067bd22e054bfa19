"""``uplift paints``: measured paints, their mixtures and recipes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from uplift.common.text import pluralise

from .. import options
from ..output.console import paragraph, print_json, say
from ..output.progress import progress_bar
from ..outputs import check_outputs
from ..paints import (
    fit_fields,
    match_fields,
    paint_fields,
    plot_recipes,
    print_fit,
    print_paints,
    print_recipes,
    read_target,
)
from ..startup import enable_jit_cache
from .mix import command as mix

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.paint.optics import Surface

paints_option = click.option(
    "--paints",
    "paints_path",
    metavar="FILE",
    required=True,
    type=click.Path(),
    help="Paints by 'uplift paints fit'.",
)
paint_names = options.repeatable(
    "--paint", "names", "Use this paint only", "all of the file", metavar="NAME"
)


@click.group(
    "paints",
    cls=options.Group,
    help="""Mix your own paints: fit them to measured samples, and find recipes.

    Measure each paint alone and mixed with white, write the parts of each sample into a
    table, and fit. Mixtures of the paints are then predicted, and recipes for colours
    and pictures found.

    \b
    Examples:
      uplift paints fit swatches.csv -o paints.toml
      uplift paints match '#3e7d4b' --paints paints.toml
      uplift mix '3:lemon yellow' '1:deep blue' --paints paints.toml
      uplift export paints.toml -o paints.html
    """,
)
def command() -> None:
    """Hold the subcommands."""


command.add_command(mix)


@command.command(
    "fit",
    help="""Fit the absorption and scattering of paints to measured samples with known
    parts.

    SAMPLES is a table with a row per sample: its name, a column of parts for each
    paint, and either reflectances at wavelengths or a column 'colour' with #rrggbb.
    Films have a thickness and a ground: white, black, or the name of a row without
    parts. Spectra in another format have their parts in --recipes, by name.

    The table lists how well the samples are predicted, what the paints are known to,
    and which samples to measure next.

    \b
    Examples:
      uplift paints fit swatches.csv -o paints.toml
      uplift paints fit swatches.csv --refractive-index 1.5 -o oil.toml
    """,
)
@click.argument("samples_path", metavar="SAMPLES", type=click.Path())
@click.option(
    "--recipes",
    metavar="FILE",
    type=click.Path(),
    help="Table of the parts, by the names of samples. [default: SAMPLES]",
)
@options.number(
    "--refractive-index",
    metavar="N",
    help="Refractive index of the binder; 1 leaves out the surface. [default: the "
    "surface is fitted]",
)
@options.number(
    "--surface-reflectance",
    metavar="K1",
    help="Saunderson's reflectance of the surface for light from air.",
)
@options.number(
    "--internal-reflectance",
    metavar="K2",
    help="Saunderson's reflectance of the surface for light from within.",
)
@options.output(help="File to write.", default="paints.toml")
@options.table_or_json
@options.force
def fit(
    samples_path: str,
    recipes: str | None,
    refractive_index: float | None,
    surface_reflectance: float | None,
    internal_reflectance: float | None,
    output: str,
    style: str,
    force: bool,
) -> None:
    enable_jit_cache()
    from uplift.extras import paint

    surface = _surface(refractive_index, surface_reflectance, internal_reflectance)
    check_outputs(output)
    samples = paint.read_paint_samples(samples_path, recipes)
    with progress_bar("fitting paints", quiet=style == "json") as progress:
        fitted = paint.fit_paints(samples, surface=surface, progress=progress)
        advice = paint.advise_samples(fitted)
    paint.write_paints(fitted.paints, output, force=force)
    if style == "json":
        print_json({"output": output, **fit_fields(fitted, advice)})
        return
    print_fit(fitted, advice)
    for note in samples.notes:
        paragraph(f"{samples_path if recipes is None else recipes}: {note}")
    say(f"{output}: {pluralise(len(fitted.paints), 'paint')}", err=True)


def _surface(
    index: float | None, outside: float | None, inside: float | None
) -> Surface | None:
    """Return the surface that options state, None if it is to be fitted."""
    from uplift.extras.paint.optics import Surface

    given = (index, outside, inside)
    if all(value is None for value in given):
        return None
    if index is None and (outside is None or inside is None):
        raise click.UsageError(
            "--surface-reflectance and --internal-reflectance require each other."
        )
    of_index = Surface.of_index(1.0 if index is None else index)
    return Surface(
        of_index.outside if outside is None else outside,
        of_index.inside if inside is None else inside,
    )


@command.command(
    "match",
    help="""Find the parts of paints whose mixture comes nearest to a colour.

    COLOUR is '#rrggbb', 'r,g,b' in linear RGB, or an entry of --atlas. The spectrum
    that it has is measured (--atlas, --spectrum) or that of a cube; the lights state
    how far the match holds elsewhere.

    \b
    Examples:
      uplift paints match '#3e7d4b' --paints paints.toml
      uplift paints match '#3e7d4b' --paints paints.toml --count 2 --light A
      uplift paints match green --atlas macbeth --paints paints.toml --plot
      uplift paints match '#c8a878' --paints paints.toml --thickness 0.2
    """,
)
@click.argument("colour", metavar="[COLOUR]", required=False)
@paints_option
@paint_names
@click.option(
    "--spectrum",
    "spectrum_path",
    metavar="FILE",
    type=click.Path(),
    help="Measured spectrum to match, the first of the file.",
)
@click.option(
    "--count",
    metavar="N",
    type=options.Whole(1, 5),
    default=3,
    help="Most paints of a recipe.",
)
@click.option(
    "--parts",
    "steps",
    metavar="N",
    type=options.Whole(1, 10_000),
    default=100,
    help="Most parts of a recipe in all.",
)
@click.option(
    "--alternatives",
    metavar="N",
    type=options.Whole(1, 100),
    default=5,
    help="Number of recipes.",
)
@options.light("Light under which the colours should agree", "D65")
@options.number(
    "--thickness",
    metavar="X",
    help="Thickness of the layer, in that of the measured films. [default: opaque]",
)
@click.option(
    "--ground", metavar="COLOUR", help="Ground of the layer. [default: white]"
)
@options.cube()
@options.atlas("Measured spectra whose entries are colours", "none")
@options.plot("Plot the colour and the recipes")
@options.table_or_json
@options.force
def match(
    colour: str | None,
    paints_path: str,
    names: Sequence[str],
    spectrum_path: str | None,
    count: int,
    steps: int,
    alternatives: int,
    lights: Sequence[Illuminant],
    thickness: float | None,
    ground: str | None,
    cube_path: str | None,
    files: Sequence[str],
    plot_path: str | None,
    style: str,
    force: bool,
) -> None:
    from uplift.extras import paint

    if (colour is None) == (spectrum_path is None):
        raise click.UsageError("Give one of COLOUR and --spectrum.")
    check_outputs(plot_path, inputs=[paints_path])
    paints = paint.read_paints(paints_path)
    if names:
        paints = paints.select(names)
    target = read_target(
        paints, colour, spectrum_path, cube_path, files, lights, thickness, ground
    )
    found = paint.match(
        target, paints, count=count, steps=steps, alternatives=alternatives
    )
    if plot_path is not None:
        plot_recipes(target, found, plot_path, force=force)
    if style == "json":
        print_json(match_fields(target, paints, found))
    else:
        print_recipes(target, paints, found, count)


@command.command(
    "info",
    help="""Show the paints of a file: colours of mass tone and tint, and what they are
    known to.

    \b
    Examples:
      uplift paints info paints.toml
      uplift paints info paints.toml --format json
    """,
)
@click.argument("paints_path", metavar="PAINTS.toml", type=click.Path())
@options.table_or_json
def info(paints_path: str, style: str) -> None:
    from uplift.extras.paint.paints_file import read_paints

    paints = read_paints(paints_path)
    if style == "json":
        print_json(paint_fields(paints))
    else:
        print_paints(paints)
