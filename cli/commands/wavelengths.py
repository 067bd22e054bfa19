"""``uplift wavelengths``: as few wavelengths as a scene needs, and what to do with them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..output.progress import spinner
from ..output.wavelengths_output import PRINTERS, Found
from ..params.options import force_option, format_option, sensor_options
from ..params.study_atlases import SHIPPED, read_each
from ..params.wavelengths import parse_wavelengths

if TYPE_CHECKING:
    from uplift.atlas import Atlas

ONE_OF_THREE = "Of --count, --target and --at give one. See 'uplift wavelengths --help'."


@click.command("wavelengths")
@click.option("--count", metavar="N", type=int, help="So many wavelengths, 1 to 40.")
@click.option("--target", metavar="ΔE", type=float, help="The fewest that stay under this ΔE00.")
@click.option(
    "--at", metavar="NM", help="These, START:END:STEP or a list: weights and powers alone are fitted."
)
@click.option(
    "--measure",
    type=click.Choice(("mean", "p95", "max")),
    help="What the target is about, over all materials under all lights. [default: max]",
)
@click.option(
    "--method",
    type=click.Choice(("optimised", "meyer", "uniform", "bins", "fitted")),
    help="All fitted; Meyer's quadrature; even wavelengths: read off, in bins, or with weights fitted. "
    "[default: optimised]",
)
@click.option(
    "--atlas",
    "files",
    metavar="FILE",
    multiple=True,
    help=f"Materials; may be repeated. [default: {SHIPPED}]",
)
@click.option(
    "--light", "lights", metavar="NAME", multiple=True, help="Light; may be repeated. [default: D65]"
)
@sensor_options
@format_option("table", "json", "csv")
@click.option("--plot", "plot_path", metavar="PNG", help="Draw lights, wavelengths and weights.")
@force_option()
def command(
    count: int | None,
    target: float | None,
    at: str | None,
    measure: str | None,
    method: str | None,
    files: tuple[str, ...],
    lights: tuple[str, ...],
    space: str,
    illuminant: str,
    observer: str | None,
    style: str,
    plot_path: str | None,
    force: bool,
) -> None:
    """Choose the wavelengths that a renderer traces, for the materials and lights of a scene.

    One set serves all lights. At each wavelength a light sends its own power, which holds what its spectrum
    does nearby: lines of a lamp that lie between the wavelengths are not lost. Radiance, power times
    reflectance, is summed with the weights to XYZ, or to linear RGB in which white under --illuminant is
    (1, 1, 1). Errors are ΔE00 against the sum over every nanometre from 380 to 770.

    \b
    Examples:
      uplift wavelengths --count 8
      uplift wavelengths --target 1 --light D65 --light FL11 --plot wavelengths.png
      uplift wavelengths --target 0.5 --measure p95 --atlas paints.csv --format json
      uplift wavelengths --at 400:700:20 --light A --light LED-B3 --format csv
      uplift wavelengths --count 4 --method meyer --light C --atlas atlases/macbeth.txt
    """
    if sum(option is not None for option in (count, target, at)) != 1:
        raise click.UsageError(ONE_OF_THREE)
    if (measure is not None and target is None) or (method is not None and at is not None):
        raise click.UsageError("--measure goes with --target, --method with --count or --target.")
    given = parse_wavelengths(at)
    from uplift.atlas import merge, on_grid
    from uplift.colorimetry.observer import DEFAULT_OBSERVER, sensor
    from uplift.common.files import check_output
    from uplift.scene import wavelengths

    if plot_path is not None:
        check_output(plot_path, force=force)
    seen_by = observer or DEFAULT_OBSERVER
    camera = sensor(space, illuminant, seen_by)
    spectra: Atlas = merge(read_each(files).values())
    setting = wavelengths.make_setup(
        on_grid(spectra, wavelengths.grid()), lights or ("D65",), observer_name=seen_by
    )
    with spinner("fitting wavelengths"):
        if given is None:
            choice = wavelengths.choose(
                setting, count=count, target=target, measure=measure or "max", method=method or "optimised"
            )
        else:
            choice = wavelengths.fit_weights(setting, given)
    if plot_path is not None:
        from uplift.scene.wavelengths.plots import plot_choice

        plot_choice(setting, choice, plot_path, force=force)
    PRINTERS[style](Found(choice, camera, spectra.names))
