"""``uplift advise``: the expected errors of a scene, and what to measure next."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.text import pluralise

from .. import options
from ..inputs import expand_patterns, read_pictures
from ..output.console import make_table, print_json, say, show
from ..output.progress import progress_bar
from ..outputs import check_outputs

SHOWN = 4
"""Images of a picture."""


@click.command(
    "advise",
    help="""Estimate the errors of the colours of images, and name the swatches whose
    measurement lowers them most.

    \b
    Examples:
      uplift advise wood.png --cube macbeth-32.uplift
      uplift advise wood.png --cube macbeth-32.uplift --plot advice.png
      uplift advise wood.png --cube macbeth-32.uplift --count 12 --format json

    Errors are standard errors, ΔE00 under each --light, averaged over the area of the
    images. A swatch is a colour of the images: measure a material that has it, add it
    to the atlas, and build the cube again. Its gain is by how much the mean of the
    errors is expected to fall, after the swatches above it. It supposes that all of a
    colour is one material, and that colours close to it are like it as far as those of
    the atlas are.
    """,
)
@click.argument("images", metavar="IMAGE...", nargs=-1, required=True)
@options.cube(" with an atlas of at least 8 entries.", required=True)
@options.light("Illuminant of the scene", "A FL11 HP1")
@click.option(
    "--count",
    metavar="N",
    type=options.Whole(1, 100),
    default=6,
    help="Number of swatches.",
)
@options.pixels()
@options.plot("Draw the first 4 images, their expected errors and the swatches")
@options.output_format("table", "json")
@options.force
def command(
    images: tuple[str, ...],
    cube_path: str,
    lights: tuple[Illuminant, ...],
    count: int,
    plot_path: str | None,
    style: str,
    force: bool,
    **pixels: Any,
) -> None:
    from uplift.colorimetry import observer
    from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
    from uplift.extras.colour.srgb import hex_codes
    from uplift.extras.scene import advice
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup import load

    paths = expand_patterns(images)
    check_outputs(plot_path, inputs=paths)
    cube = load(cube_path)
    sensor = cube.data.sensor
    observer.check_distinct(lights)
    names = lights or RELIGHT_LIGHTS
    lit = [observer.light(name, cube.observer, *sensor.range) for name in names]
    with progress_bar("choosing swatches"):
        colours = advice.colour_areas(Images(tuple(map(Path, paths)), **pixels), sensor)
        before = advice.uncertainty(cube, colours, lit)
        chosen, after = advice.advise(before, count)
    rgb = colours.rgb[[swatch.colour for swatch in chosen]]
    codes = hex_codes(rgb, sensor)
    coded = list(zip(codes, chosen, strict=True))
    if plot_path is not None:
        from uplift.extras.pages.figure import write_figure

        shown = paths[:SHOWN]
        read = read_pictures(shown, sensor, **pixels)
        pictures = {path: image.rgb for path, image in zip(shown, read, strict=True)}
        texts = [
            f"{code}\nlowers the mean\nby ΔE00 {swatch.gain:.2f}"
            for code, swatch in coded
        ]
        chips = list(zip(texts, rgb, strict=True))
        figure = advice.draw_advice(cube, pictures, lit, chips)
        write_figure(figure, plot_path, force=force)
    stages = zip(lit, before.by_light(), after.by_light(), strict=True)
    errors = {light.name: {"before": now, "after": then} for light, now, then in stages}
    swatches = [{"hex": code, **asdict(swatch)} for code, swatch in coded]
    if style == "json":
        print_json(
            {"images": paths, "cube": cube_path, "lights": errors, "swatches": swatches}
        )
        return
    _print(errors, swatches)
    if plot_path is not None:
        say(plot_path, err=True)


def _print(
    errors: Mapping[str, Mapping[str, Mapping[str, float]]],
    swatches: Sequence[Mapping[str, Any]],
) -> None:
    after = f"after {pluralise(len(swatches), 'swatch')}"
    columns = ("expected ΔE00", "95 % of the area", after, "95 %")
    summary = make_table(("light",), columns)
    for name, stages in errors.items():
        numbers = [*stages["before"].values(), *stages["after"].values()]
        summary.add_row(name, *[f"{number:.2f}" for number in numbers])
    columns = ("area", "expected ΔE00", "gain in ΔE00", "mean ΔE00 after")
    table = make_table(("swatch",), columns)
    for row in swatches:
        cells = [f"{row[name]:.2f}" for name in ("error", "gain", "mean_after")]
        table.add_row(row["hex"], f"{row['area']:.1%}", *cells)
    show(summary, table)
