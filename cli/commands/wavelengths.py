"""``uplift wavelengths``: choose the wavelengths of a renderer."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from ..inputs import DEFAULT_ATLASES, parse_wavelengths, read_atlases
from ..options import (
    NUMBER,
    Whole,
    atlas_option,
    force_option,
    format_option,
    light_option,
    plot_option,
    sensor_options,
)
from ..output.console import make_table, print_csv, print_json, show
from ..output.progress import spinner

if TYPE_CHECKING:
    from uplift.atlas import Atlas
    from uplift.colorimetry.sensor import Sensor
    from uplift.scene.wavelengths import Choice, ColourErrors


@click.command("wavelengths")
@click.option("--count", metavar="N", type=Whole(), help="Number of wavelengths, 1 to 40.")
@click.option(
    "--tolerance", metavar="ΔE00", type=NUMBER, help="Choose the fewest wavelengths with an error below this ΔE00."
)
@click.option(
    "--wavelengths",
    "given",
    metavar="NM",
    help="Wavelengths as START:END:STEP or a list; only their weights and powers are fitted.",
)
@click.option(
    "--measure",
    type=click.Choice(("mean", "p95", "max")),
    help="Statistic of --tolerance over all materials and lights. [default: max]",
)
@click.option(
    "--method",
    type=click.Choice(("optimised", "meyer", "uniform", "bins", "fitted")),
    help="optimised: fit everything; meyer: Meyer's quadrature; the others use even wavelengths, sampled (uniform), "
    "averaged over bins (bins) or with fitted weights (fitted). [default: optimised]",
)
@click.option(
    "--orders",
    nargs=3,
    metavar="A C1 C2",
    type=Whole(),
    help="Meyer's quadrature with these numbers of wavelengths for the three channels, 1 to 10 each.",
)
@click.option(
    "--channels",
    type=click.Choice(("opponent", "cones", "xyz")),
    help="Channels of --orders: A C1 C2, the cones S M L, or X Y Z. [default: opponent]",
)
@atlas_option("Materials", DEFAULT_ATLASES)
@light_option("Illuminant of the scene", "D65")
@sensor_options
@format_option("table", "json", "csv")
@plot_option("Plot lights, wavelengths and weights")
@force_option
def command(
    count: int | None,
    tolerance: float | None,
    given: str | None,
    measure: str | None,
    method: str | None,
    orders: tuple[int, int, int] | None,
    channels: str | None,
    files: tuple[str, ...],
    lights: tuple[str, ...],
    space: str,
    illuminant: str,
    observer: str | None,
    style: str,
    plot_path: str | None,
    force: bool,
) -> None:
    """Choose the wavelengths at which a renderer samples the materials and lights of a scene.

    All lights share one set of wavelengths. The power of a light at a wavelength is prefiltered, so that spectral lines
    between the wavelengths count. Radiance is power times reflectance. Weighted sums of radiance give XYZ, or linear
    RGB in which white under --illuminant is (1, 1, 1). Errors are ΔE00 to sums over every nanometre from 380 to 770.

    \b
    Examples:
      uplift wavelengths --count 8
      uplift wavelengths --tolerance 1 --light D65 --light FL11 --plot wavelengths.png
      uplift wavelengths --tolerance 0.5 --measure p95 --atlas paints.csv --format json
      uplift wavelengths --wavelengths 400:700:20 --light A --format csv
      uplift wavelengths --count 4 --method meyer --light C --atlas macbeth
      uplift wavelengths --orders 3 2 1 --light C --atlas macbeth
    """
    if sum(option is not None for option in (count, tolerance, given, orders)) != 1:
        raise click.UsageError("Give one of --count, --tolerance, --wavelengths and --orders.")
    if (measure is not None and tolerance is None) or (method is not None and count is None and tolerance is None):
        raise click.UsageError("--measure requires --tolerance, --method requires --count or --tolerance.")
    if channels is not None and orders is None:
        raise click.UsageError("--channels requires --orders.")
    fixed = parse_wavelengths(given)
    from uplift.atlas import merge, on_grid
    from uplift.colorimetry.observer import DEFAULT_OBSERVER, sensor
    from uplift.common.files import check_output
    from uplift.scene import wavelengths

    if plot_path is not None:
        check_output(plot_path, inputs=files, force=force)
    observer = observer or DEFAULT_OBSERVER
    camera = sensor(space, illuminant, observer)
    atlas: Atlas = merge(read_atlases(files).values())
    setting = wavelengths.make_setup(on_grid(atlas, wavelengths.grid()), lights or ("D65",), observer_name=observer)
    with spinner("fitting wavelengths"):
        if orders is not None:
            choice = wavelengths.choose_orders(setting, orders, channels or "opponent")
        elif fixed is None:
            choice = wavelengths.choose(
                setting, count=count, target=tolerance, measure=measure or "max", method=method or "optimised"
            )
        else:
            choice = wavelengths.fit_weights(setting, fixed)
    if plot_path is not None:
        from uplift.scene.wavelengths.plots import plot_choice

        plot_choice(setting, choice, plot_path, force=force)
    PRINTERS[style](Result(choice, camera, atlas.names))


@dataclass(frozen=True, eq=False)
class Result:
    """Chosen wavelengths, the RGB space of the output, and the names of the materials."""

    choice: Choice
    sensor: Sensor
    materials: tuple[str, ...]

    def errors(self) -> Iterator[tuple[str, ColourErrors]]:
        """Yield errors by light, and for several lights also over all of them."""
        lights = self.choice.sampling.lights
        for row, light in enumerate(lights):
            yield light, self.choice.errors.under(row)
        if len(lights) > 1:
            yield "all lights", self.choice.errors

    def worst(self, errors: ColourErrors) -> str:
        """Return the material with the largest error."""
        return self.materials[int(errors.delta_e.max(axis=0).argmax())]


def _print_json(result: Result) -> None:
    sampling, sensor = result.choice.sampling, result.sensor
    fields = {
        "method": result.choice.method,
        "count": len(sampling),
        "materials": len(result.materials),
        "observer": sensor.observer,
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "wavelengths": sampling.wavelengths.tolist(),
        "to_xyz": sampling.to_xyz.tolist(),
        "to_rgb": sampling.to_rgb(sensor).tolist(),
        "powers": dict(zip(sampling.lights, sampling.powers.tolist(), strict=True)),
        "errors": {
            name: {"mean": errors.mean, "p95": errors.p95, "max": errors.max, "worst": result.worst(errors)}
            for name, errors in result.errors()
        },
    }
    print_json(fields)


def _print_csv(result: Result) -> None:
    lights = result.choice.sampling.lights
    header = ["wavelength", *"XYZ", *"rgb", *(f"power {light}" for light in lights)]
    print_csv(header, _rows(result))


def _rows(result: Result) -> Iterator[list[float]]:
    """Yield wavelength, weights to XYZ, weights to RGB and powers, per wavelength."""
    sampling = result.choice.sampling
    parts = (sampling.wavelengths[:, None], sampling.to_xyz, sampling.to_rgb(result.sensor), sampling.powers.T)
    for row in zip(*(part.tolist() for part in parts), strict=True):
        yield [number for numbers in row for number in numbers]


def _print_table(result: Result) -> None:
    sampling = result.choice.sampling
    weights = make_table((), ("nm", *"XYZRGB"), title=f"{len(sampling)} wavelengths, {result.choice.method}: weights")
    powers = make_table((), ("nm", *sampling.lights), title="power of the lights")
    for nm, *others in _rows(result):
        cells = [f"{other:.4f}" for other in others]
        weights.add_row(f"{nm:.1f}", *cells[:6])
        powers.add_row(f"{nm:.1f}", *cells[6:])
    errors_table = make_table(("light",), ("mean", "95 %", "max"), title=f"ΔE00 of {len(result.materials)} materials")
    errors_table.add_column("worst material")
    for name, errors in result.errors():
        numbers = (errors.mean, errors.p95, errors.max)
        errors_table.add_row(name, *(f"{number:.3f}" for number in numbers), result.worst(errors))
    show(weights, powers, errors_table)


PRINTERS: dict[str, Callable[[Result], None]] = {"table": _print_table, "json": _print_json, "csv": _print_csv}
