"""``uplift wavelengths``: choose the wavelengths of a renderer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..output.progress import spinner
from ..output.wavelengths_output import PRINTERS, Result
from ..params.atlases import DEFAULT_ATLASES, read_atlases
from ..params.number_types import NUMBER, Whole
from ..params.options import atlas_option, force_option, format_option, light_option, sensor_options
from ..params.plots import plot_option
from ..params.wavelengths import parse_wavelengths

if TYPE_CHECKING:
    from uplift.atlas import Atlas


@click.command("wavelengths")
@click.option("--count", metavar="N", type=Whole(), help="Number of wavelengths, 1 to 40.")
@click.option(
    "--tolerance",
    "target",
    metavar="ΔE00",
    type=NUMBER,
    help="Choose the fewest wavelengths with an error below this ΔE00.",
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
@plot_option("--plot", "plot_path", "Plot lights, wavelengths and weights")
@force_option()
def command(
    count: int | None,
    target: float | None,
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
    if sum(option is not None for option in (count, target, given, orders)) != 1:
        raise click.UsageError("Give one of --count, --tolerance, --wavelengths and --orders.")
    if (measure is not None and target is None) or (method is not None and count is None and target is None):
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
                setting, count=count, target=target, measure=measure or "max", method=method or "optimised"
            )
        else:
            choice = wavelengths.fit_weights(setting, fixed)
    if plot_path is not None:
        from uplift.scene.wavelengths.plots import plot_choice

        plot_choice(setting, choice, plot_path, force=force)
    PRINTERS[style](Result(choice, camera, atlas.names))
