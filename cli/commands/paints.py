"""``uplift paints``: measured paints, their mixtures and recipes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import options
from ..output.console import paragraph, print_json, say
from ..output.progress import progress_bar
from ..outputs import check_outputs
from ..paints import (
    hex_codes,
    paint_fields,
    plot_recipes,
    print_fit,
    print_fit_json,
    print_paints,
    print_recipes,
    recipe_rows,
)
from ..startup import enable_jit_cache
from ..surfaces import stated_surface, surface_options
from .mix import command as mix

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant

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
      uplift paints mix '3:lemon yellow' '1:deep blue' --paints paints.toml
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
@surface_options("1 leaves out the surface. [default: the surface is fitted]")
@options.output(help="File to write.", default="paints.toml")
@options.table_or_json
@options.force
def fit(
    samples_path: str,
    recipes: str | None,
    output: str,
    style: str,
    force: bool,
    **stated: Any,
) -> None:
    enable_jit_cache()
    from uplift.extras import paint

    if len(stated.keys() & options.given().keys()) == 1 and (
        stated["refractive_index"] is None
    ):
        raise click.UsageError(
            "--surface-reflectance and --internal-reflectance require each other."
        )
    surface = stated_surface(**stated)
    check_outputs(output)
    samples = paint.read_paint_samples(samples_path, recipes)
    with progress_bar("fitting paints", quiet=style == "json") as progress:
        fitted = paint.fit_paints(samples, surface=surface, progress=progress)
        advice = paint.advise_samples(fitted)
    paint.write_paints(fitted.paints, output, force=force)
    if style == "json":
        print_fit_json(fitted, advice, output)
        return
    print_fit(fitted, advice)
    for note in samples.notes:
        paragraph(f"{samples_path if recipes is None else recipes}: {note}")
    say(f"{output}: {pluralise(len(fitted.paints), 'paint')}", err=True)


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
    from uplift.extras.paint.mixture import (
        SpectrumResolver,
        read_entries,
        sample_entry,
    )
    from uplift.lookup.cube import load

    if (colour is None) == (spectrum_path is None):
        raise click.UsageError("Give one of COLOUR and --spectrum.")
    check_outputs(plot_path, inputs=[paints_path])
    paints = paint.read_paints(paints_path)
    if names:
        paints = paints.select(names)
    nm = paints.wavelengths
    resolver = SpectrumResolver(load(cube_path), read_entries(files), nm)
    if spectrum_path is None:
        reflectance = resolver.spectrum(str(colour))
    else:
        reflectance = sample_entry(read_entries([spectrum_path])[0], nm)
    target = paint.PaintTarget(
        reflectance,
        tuple(map(paints.light, lights or ("D65",))),
        thickness,
        1.0 if ground is None else resolver.spectrum(ground),
    )
    recipes = paint.match(target, paints, count=count, steps=steps)
    if plot_path is not None:
        plot_recipes(target, recipes, plot_path, force=force)
    (code,) = hex_codes(paints, reflectance[None])
    rows = recipe_rows(target, paints, recipes)
    if style == "json":
        names = [light.name for light in target.lights]
        print_json({"colour": code, "lights": names, "recipes": rows})
    else:
        print_recipes(rows, recipes, code, min(count, len(paints)))


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
