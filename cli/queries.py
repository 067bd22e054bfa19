"""Colours that are looked up in a cube, and their answers, block by block."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import ColourError, UpliftWarning
from uplift.common.text import pluralise

from . import options
from .inputs import check_range, find_input_space
from .output.diagnostics import warn

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.colorimetry.sensor import Light, Sensor
    from uplift.common.arrays import Array
    from uplift.extras.colour.colour_source import ColourSource
    from uplift.extras.colour.query import QueryBlock
    from uplift.extras.photographs.colour import PhotographedColour

PACKAGED = "packaged"
"""Name of the cube that answers without --cube."""


def colour_sources(xyz: str, space: str) -> options.Decorator:
    """COLOUR and the other sources of colours, for
    `find_colours`.
    """
    return options.stacked(
        click.argument("colour", metavar="[COLOUR]...", nargs=-1),
        click.option(
            "--input",
            "input_path",
            metavar="FILE",
            help="Table of colours, one per line; '-' is standard input.",
        ),
        options.number("--xyz", nargs=3, metavar="X Y Z", help=f"Colour by XYZ {xyz}."),
        options.number(
            "--xy",
            nargs=2,
            metavar="X Y",
            help="Colour by chromaticity, with --luminance, as for --xyz.",
        ),
        options.number(
            "--luminance", metavar="Y", help="Luminance of --xy, where white has 1."
        ),
        options.flag(
            "--encoded", help="Numbers are encoded 8-bit codes from 0 to 255."
        ),
        options.input_space("the colours", default=space),
    )


def find_colours(
    colour: tuple[str, ...],
    input_path: str | None,
    xyz: tuple[float, float, float] | None,
    xy: tuple[float, float] | None,
    luminance: float | None,
    encoded: bool,
    input_space: str | None,
) -> ColourSource:
    """Return the source that the values of `colour_sources` name. Raises click's error
    for none or several.
    """
    if colour == ("-",):
        colour = ()
        input_path = input_path or "-"
    if (xy is None) != (luminance is None) or (xyz is not None and xy is not None):
        raise click.UsageError(
            "--xy X Y and --luminance Y require each other, and --xyz is an "
            "alternative."
        )
    if xy is not None and luminance is not None:
        x, y = xy
        if not y > 0:
            raise ColourError(
                f"y of a chromaticity must be positive, got {y:g}",
                hint="give CIE x and y",
            )
        xyz = x * luminance / y, luminance, (1 - x - y) * luminance / y
    if (xyz is not None) + bool(colour) + (input_path is not None) != 1:
        raise click.UsageError("Give colours, --input FILE, '-', --xyz or --xy.")
    from uplift.extras.colour.colour_source import ColourSource

    space = None if input_space is None else find_input_space(input_space)
    return ColourSource(colour, input_path, xyz, encoded, space)


colour_options = options.stacked(
    colour_sources(
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
        from uplift.lookup.cube import load

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
        self.displays: Sequence[Sensor] = ()
        """Linear sRGB with the white of each light."""
        if lights:
            from uplift.colorimetry.observer import display_sensors
            from uplift.colorimetry.observer import lights as find_lights

            observer = self.cube.observer
            self.lights = find_lights(lights, observer, data.sensor.range)
            self.displays = display_sensors(lights, observer, *data.sensor.range)

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
