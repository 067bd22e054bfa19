"""``uplift advise``: the expected errors of a scene, and what to measure or photograph
next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise
from uplift.extras.images.sequences import expand_patterns

from .. import options
from ..also import noise
from ..inputs import read_pictures
from ..output.console import say
from ..output.progress import progress_bar
from ..output.table import Format, Table, print_result, swatch
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.scene.second_light import RemainingError

SHOWN = 4
"""Images of a picture."""
SECOND_LIGHT = {"light": "second light", "mean": "expected ΔE00", "errors": "largest"}
LIGHT = {"light": "light", "before": "expected ΔE00 (95 % of the pixels)"}
SWATCH = {
    "hex": "swatch",
    "share": "pixels like it",
    "error": "expected ΔE00",
    "gain": "gain in the mean",
    "mean_after": "mean ΔE00 after",
}


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
    from uplift.colorimetry.observer import lights as find_lights
    from uplift.extras.colour import light_sets
    from uplift.extras.colour.srgb import hex_codes
    from uplift.extras.scene import advice
    from uplift.extras.scene import second_light as photographs
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup.cube import load

    _check_options(second_light=second_light)
    paths = expand_patterns(images)
    check_outputs(plot_path, inputs=paths)
    cube = load(cube_path)
    sensor = cube.data.sensor
    usual = light_sets.HELD_OUT_LIGHTS if second_light else light_sets.RELIGHT_LIGHTS
    lit = find_lights(lights or usual, cube.observer, sensor.range)
    data: dict[str, Any] = {"images": paths, "cube": cube_path}
    with progress_bar("comparing lights" if second_light else "choosing swatches"):
        colours = advice.colour_areas(Images(tuple(map(Path, paths)), **pixels), sensor)
        if second_light:
            assumed = noise or photographs.NOISE
            compared = candidates or photographs.default_candidates(cube)
            without = photographs.error_without(cube, colours, lit)
            ranked = photographs.rank_second_lights(
                cube, colours, compared, lit, assumed
            )
        else:
            before = advice.uncertainty(cube, colours, lit)
            chosen, after = advice.advise(before, count)
    if second_light:
        data["noise"] = {"share": assumed[0], "floor": assumed[1]}
        _print_lights(style, data, without, ranked)
        return
    rgb = colours.rgb[[row.colour for row in chosen]]
    codes = hex_codes(rgb, sensor)
    swatches = [
        {"hex": code, **asdict(row)} for code, row in zip(codes, chosen, strict=True)
    ]
    stages = zip(lit, before.by_light(), after.by_light(), strict=True)
    errors = {light.name: {"before": now, "after": then} for light, now, then in stages}
    if plot_path is not None:
        from uplift.extras.pages.figure import write_figure

        shown = paths[:SHOWN]
        read = read_pictures(shown, sensor, **pixels)
        pictures = dict(zip(shown, (picture.rgb for picture in read), strict=True))
        texts = map("{hex}  ΔE00 −{gain:.2f}".format_map, swatches)
        chips = list(zip(texts, rgb, strict=True))
        figure = advice.draw_advice(cube, pictures, lit, chips)
        write_figure(figure, plot_path, force=force)
    data |= {"lights": errors, "swatches": swatches}
    stage = "{mean:.2f} ({p95:.2f})".format_map
    by_light = Table(
        [{"light": name, **stages} for name, stages in errors.items()],
        LIGHT | {"after": f"after {pluralise(len(swatches), 'swatch')}"},
        formats={"before": stage, "after": stage},
    )
    formats: dict[str, Format] = {
        "hex": lambda code: swatch(code, code),
        "share": ".1%",
    }
    by_swatch = Table(swatches, SWATCH, digits=".2f", formats=formats)
    print_result(style, data, by_light, by_swatch)
    if plot_path is not None and style != "json":
        say(plot_path, err=True)


def _check_options(*, second_light: bool) -> None:
    """Raise a usage error for options of the other kind of advice."""
    given = options.given()
    relation = "does not apply to" if second_light else "requires"
    for name in ("count", "plot_path") if second_light else ("candidates", "noise"):
        if name in given:
            raise click.UsageError(f"{given[name]} {relation} --second-light.")


def _print_lights(
    style: str,
    data: dict[str, Any],
    without: RemainingError,
    ranked: Sequence[RemainingError],
) -> None:
    rows = [
        {"light": error.light, "mean": error.mean, "errors": error.by_light}
        for error in (*ranked, without)
    ]
    data |= {"without": rows[-1], "second_lights": rows[:-1]}
    formats: dict[str, Format] = {"light": _describe, "errors": _largest}
    print_result(style, data, Table(rows, SECOND_LIGHT, digits=".2f", formats=formats))


def _describe(light: str) -> str:
    from uplift.extras.colour.light_sets import DESCRIPTIONS

    return f"{light}, {DESCRIPTIONS[light]}" if light in DESCRIPTIONS else light


def _largest(errors: dict[str, float]) -> str:
    light = max(errors, key=errors.__getitem__)
    return f"{errors[light]:.2f} under {light}"
