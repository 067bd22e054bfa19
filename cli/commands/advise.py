"""``uplift advise``: the expected errors of a scene, and what to measure or photograph
next.
"""

from __future__ import annotations

from dataclasses import asdict
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.text import pluralise
from uplift.extras.images.sequences import expand_patterns

from .. import options
from ..also import noise
from ..inputs import read_pictures
from ..output.console import make_table, print_json, say, show
from ..output.progress import progress_bar
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.extras.scene.second_light import RemainingError

SHOWN = 4
"""Images of a picture."""
DEFAULT_NOISE = 0.005, 0.0005
"""Noise of photographs that are not taken yet."""


@click.command(
    "advise",
    help="""Estimate the errors of the colours of images, and name the swatches whose
    measurement lowers them most, or the best light for a second photograph.

    \b
    Examples:
      uplift advise wood.png
      uplift advise wood.png --cube macbeth-32.uplift
      uplift advise wood.png --cube macbeth-32.uplift --plot advice.png
      uplift advise wood.png --cube macbeth-32.uplift --count 12 --format json
      uplift advise wood.png --second-light
      uplift advise wood.png --second-light --candidate A --candidate led

    Errors are standard errors, ΔE00 under each --light, averaged over the area of the
    images. A swatch is a colour of the images: measure a material that has it, add it
    to the atlas, and build the cube again. Its gain is by how much the mean of the
    errors is expected to fall, after the swatches above it: that of a small object
    lowers the mean of all pixels little. Pixels like it are those of whose spectra it
    halves what is unknown, or more. It supposes that all of a colour is one material,
    and that colours close to it are like it as far as those of the atlas are. Without
    an atlas, errors are those of materials of unknown families.

    With --second-light, candidates for the light of a second photograph are ranked by
    the errors that are expected to remain, for photographs with --noise,
    by default 0.5%,0.0005.
    """,
)
@click.argument("images", metavar="IMAGE...", nargs=-1, required=True)
@options.cube()
@options.light(
    "Illuminant of the scene",
    "A FL11 HP1; with --second-light also FL2 FL7 LED-B3 LED-RGB1",
)
@options.flag(
    "--second-light", "second_light", help="Rank lights in place of swatches."
)
@options.named_lights(
    "--candidate",
    "candidates",
    "Light of a second photograph",
    "common lights",
    examples=options.LAMPS,
)
@noise
@click.option(
    "--count",
    metavar="N",
    type=options.Whole(1, 100),
    default=6,
    help="Number of swatches.",
)
@options.pixels()
@options.plot("Draw the first 4 images, their expected errors and the swatches")
@options.table_or_json
@options.force
def command(
    images: tuple[str, ...],
    cube_path: str | None,
    lights: tuple[Illuminant, ...],
    second_light: bool,
    candidates: tuple[Illuminant, ...],
    noise: tuple[float, float] | None,
    count: int,
    plot_path: str | None,
    style: str,
    force: bool,
    **pixels: Any,
) -> None:
    given = options.given()
    for_swatches = ("count", "plot_path")
    for_photographs = ("candidates", "noise")
    if unused := [name for name in for_swatches if second_light and name in given]:
        problem = f"{given[unused[0]]} does not apply to --second-light."
        raise click.UsageError(problem)
    if unused := [
        name for name in for_photographs if not second_light and name in given
    ]:
        raise click.UsageError(f"{given[unused[0]]} requires --second-light.")
    if second_light:
        assumed = noise or DEFAULT_NOISE
        _advise_light(images, cube_path, lights, candidates, assumed, style, pixels)
        return
    _advise_swatches(images, cube_path, lights, count, plot_path, style, force, pixels)


def _advise_light(
    images: tuple[str, ...],
    cube_path: str | None,
    lights: tuple[Illuminant, ...],
    candidates: tuple[Illuminant, ...],
    noise: tuple[float, float],
    style: str,
    pixels: dict[str, Any],
) -> None:
    """Rank lights of a second photograph, and print them."""
    from uplift.colorimetry.observer import lights as find_lights
    from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
    from uplift.extras.scene import second_light
    from uplift.extras.scene.advice import colour_areas
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup.cube import load

    paths = expand_patterns(images)
    cube = load(cube_path)
    sensor = cube.data.sensor
    compared = candidates or second_light.default_candidates(cube)
    lit = find_lights(lights or HELD_OUT_LIGHTS, cube.observer, sensor.range)
    with progress_bar("comparing lights"):
        colours = colour_areas(Images(tuple(map(Path, paths)), **pixels), sensor)
        without = second_light.error_without(cube, colours, lit)
        ranked = second_light.rank_second_lights(cube, colours, compared, lit, noise)
    if style == "json":
        rows = [
            {"light": row.light, "mean": row.mean, "errors": row.by_light}
            for row in (without, *ranked)
        ]
        print_json(
            {
                "images": paths,
                "cube": cube_path,
                "noise": {"share": noise[0], "floor": noise[1]},
                "without": rows[0],
                "second_lights": rows[1:],
            }
        )
        return
    _print_ranking(without, ranked)


def _print_ranking(without: RemainingError, ranked: list[RemainingError]) -> None:
    from uplift.extras.colour.light_sets import DESCRIPTIONS

    table = make_table(("second light", ""), ("expected ΔE00", "largest", "under"))
    for row in (*ranked, without):
        name = row.light or "none"
        worst = max(row.by_light, key=row.by_light.__getitem__)
        numbers = (f"{row.mean:.2f}", f"{row.by_light[worst]:.2f}")
        table.add_row(name, DESCRIPTIONS.get(name, ""), *numbers, worst)
    show(table)


def _advise_swatches(
    images: tuple[str, ...],
    cube_path: str | None,
    lights: tuple[Illuminant, ...],
    count: int,
    plot_path: str | None,
    style: str,
    force: bool,
    pixels: dict[str, Any],
) -> None:
    """Choose swatches, and print and draw them."""
    from uplift.colorimetry.observer import lights as find_lights
    from uplift.extras.colour.light_sets import RELIGHT_LIGHTS
    from uplift.extras.colour.srgb import hex_codes
    from uplift.extras.scene import advice
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup.cube import load

    paths = expand_patterns(images)
    check_outputs(plot_path, inputs=paths)
    cube = load(cube_path)
    sensor = cube.data.sensor
    lit = find_lights(lights or RELIGHT_LIGHTS, cube.observer, sensor.range)
    with progress_bar("choosing swatches"):
        colours = advice.colour_areas(Images(tuple(map(Path, paths)), **pixels), sensor)
        before = advice.uncertainty(cube, colours, lit)
        chosen, after = advice.advise(before, count)
    rgb = colours.rgb[[swatch.colour for swatch in chosen]]
    swatches = [
        {"hex": code, **asdict(swatch)}
        for code, swatch in zip(hex_codes(rgb, sensor), chosen, strict=True)
    ]
    if plot_path is not None:
        from uplift.extras.pages.figure import write_figure

        shown = paths[:SHOWN]
        images_read = read_pictures(shown, sensor, **pixels)
        pictures = {
            path: picture.rgb for path, picture in zip(shown, images_read, strict=True)
        }
        texts = map("{hex}  ΔE00 −{gain:.2f}".format_map, swatches)
        chips = list(zip(texts, rgb, strict=True))
        figure = advice.draw_advice(cube, pictures, lit, chips)
        write_figure(figure, plot_path, force=force)
    stages = zip(lit, before.by_light(), after.by_light(), strict=True)
    errors = {light.name: {"before": now, "after": then} for light, now, then in stages}
    if style == "json":
        print_json(
            {
                "images": paths,
                "cube": cube_path,
                "lights": errors,
                "swatches": swatches,
            }
        )
        return
    _print_tables(errors, swatches)
    if plot_path is not None:
        say(plot_path, err=True)


def _print_tables(
    errors: dict[str, dict[str, dict[str, float]]], swatches: list[dict[str, Any]]
) -> None:
    headings = (
        "expected ΔE00",
        "95 % of the pixels",
        f"after {pluralise(len(swatches), 'swatch')}",
        "95 %",
    )
    summary = make_table(("light",), headings)
    for name, stages in errors.items():
        numbers = chain.from_iterable(stage.values() for stage in stages.values())
        summary.add_row(name, *map("{:.2f}".format, numbers))
    table = make_table(
        ("swatch",),
        ("pixels like it", "expected ΔE00", "gain in the mean", "mean ΔE00 after"),
    )
    for row in swatches:
        share = f"{row['share']:.1%}"
        reduced = (row["error"], row["gain"], row["mean_after"])
        table.add_row(row["hex"], share, *map("{:.2f}".format, reduced))
    show(summary, table)
