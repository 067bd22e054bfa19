"""``uplift lab wavelengths``: choose the wavelengths of a renderer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import options, sensor_options
from ..inputs import DEFAULT_ATLASES, atlas_files, check_range, read_atlases
from ..output.console import print_json, say
from ..output.progress import progress_bar
from ..output.table import Table
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.extras.papers.wavelengths.choice import Choice
    from uplift.extras.papers.wavelengths.sampling import RenderSetup


@click.command(
    "wavelengths",
    cls=options.Command,
    everyday=("count", "tolerance", "files", "lights", "style", "plot_path"),
    help="""Choose the wavelengths at which a renderer samples the materials and lights
    of a scene.

    All lights share one set of wavelengths. The power of a light at a wavelength is
    prefiltered, so that spectral lines between the wavelengths count. Radiance is power
    times reflectance. Weighted sums of radiance give XYZ, or linear RGB in which white
    under --illuminant is (1, 1, 1). Errors are ΔE00 to sums over every nanometre from
    380 to 770.

    \b
    Examples:
      uplift lab wavelengths --count 8
      uplift lab wavelengths --tolerance 1 --light D65 --light FL11 --plot w.png
      uplift lab wavelengths --tolerance 0.5 --atlas paints.csv
      uplift lab wavelengths --wavelengths 400:700:20 --light A --format csv
      uplift lab wavelengths --count 4 --method meyer --light C --atlas macbeth
      uplift lab wavelengths --orders 3 2 1 --light C --atlas macbeth
    """,
)
@options.whole("--count", metavar="N", help="Number of wavelengths, 1 to 40.")
@options.tolerance(
    help="Choose the fewest wavelengths with all errors below this ΔE00."
)
@options.wavelengths("; only their weights and powers are fitted.")
@click.option(
    "--method",
    type=click.Choice(("optimised", "meyer", "uniform", "bins", "fitted")),
    help="optimised: fit everything; meyer: Meyer's quadrature; the others use even "
    "wavelengths, sampled (uniform), "
    "averaged over bins (bins) or with fitted weights (fitted). [default: optimised]",
)
@options.whole(
    "--orders",
    nargs=3,
    metavar="A C1 C2",
    help="Meyer's quadrature with these numbers of wavelengths for the three "
    "channels, 1 to 10 each.",
)
@click.option(
    "--channels",
    type=click.Choice(("opponent", "cones", "xyz")),
    help=(
        "Channels of --orders: A C1 C2, the cones S M L, or X Y Z. [default: opponent]"
    ),
)
@options.atlas("Materials", DEFAULT_ATLASES)
@options.light("Illuminant of the scene", "D65")
@sensor_options.sensor
@options.table_json_or_csv
@options.plot("Plot lights, wavelengths and weights")
@options.force
def command(
    files: Sequence[str],
    lights: Sequence[Illuminant],
    space: str,
    illuminant: Illuminant,
    observer: str,
    style: str,
    plot_path: str | None,
    force: bool,
    **goal: Any,
) -> None:
    _check_goal()
    from uplift.atlas.atlas import merge
    from uplift.atlas.resampling import on_grid
    from uplift.colorimetry.observer import require_observer, sensor
    from uplift.extras.papers.wavelengths.sampling import grid, make_setup

    check_outputs(plot_path, inputs=atlas_files(files))
    require_observer(observer, "weights of wavelengths")
    target = sensor(space, illuminant, observer)
    atlas = merge(read_atlases(files).values())
    reflectances = on_grid(atlas, grid())
    setup = make_setup(reflectances, lights or ("D65",), observer_name=observer)
    with progress_bar("fitting wavelengths"):
        choice = _choose(setup, **goal)
    if plot_path is not None:
        from uplift.extras.papers.wavelengths.plots import plot_choice

        plot_choice(setup, choice, plot_path, force=force)
        say(f"{plot_path}: lights, wavelengths and weights", err=True)
    result = _result(choice, target, atlas.names)
    rows = _rows(result)
    if style == "json":
        print_json(result)
    elif style == "csv":
        Table(rows).print_csv()
    else:
        _print_tables(result, rows)


def _check_goal() -> None:
    given = options.given().keys()
    if len(given & {"count", "tolerance", "wavelengths", "orders"}) != 1:
        raise click.UsageError(
            "Give one of --count, --tolerance, --wavelengths and --orders."
        )
    if "method" in given and not given & {"count", "tolerance"}:
        raise click.UsageError("--method requires --count or --tolerance.")
    if "channels" in given and "orders" not in given:
        raise click.UsageError("--channels requires --orders.")


def _choose(
    setup: RenderSetup,
    count: int | None,
    tolerance: float | None,
    wavelengths: Array | None,
    method: str | None,
    orders: tuple[int, int, int] | None,
    channels: str | None,
) -> Choice:
    from uplift.extras.papers.wavelengths import choice

    if orders is not None:
        return choice.choose_orders(setup, orders, channels or "opponent")
    if wavelengths is not None:
        check_range(wavelengths, setup.wavelengths)
        return choice.fit_weights(setup, wavelengths)
    return choice.choose(
        setup, count=count, target=tolerance, method=method or "optimised"
    )


def _result(choice: Choice, sensor: Sensor, materials: Sequence[str]) -> dict[str, Any]:
    """Return a choice as JSON values; its errors are those of ``materials``."""
    from uplift.extras.report.comparison import mean_p95_max

    sampling = choice.sampling
    by_light = dict(zip(sampling.lights, choice.errors, strict=True))
    if len(by_light) > 1:
        by_light["all lights"] = choice.errors
    errors = {}
    for light, delta_e in by_light.items():
        worst = materials[delta_e.argmax() % len(materials)]
        errors[light] = {**mean_p95_max(delta_e), "worst": worst}
    return {
        "method": choice.method,
        "count": len(sampling),
        "materials": len(materials),
        "observer": sensor.observer,
        "space": sensor.space,
        "illuminant": sensor.illuminant,
        "wavelengths": sampling.wavelengths.tolist(),
        "to_xyz": sampling.to_xyz.tolist(),
        "to_rgb": sampling.to_rgb(sensor).tolist(),
        "powers": dict(zip(sampling.lights, sampling.powers.tolist(), strict=True)),
        "errors": errors,
    }


def _rows(result: Mapping[str, Any]) -> list[dict[str, float]]:
    """Return wavelength, weights to XYZ and to RGB, and powers of the lights."""
    import numpy as np

    powers = result["powers"]
    names = ["wavelength", *"XYZrgb", *map("power {}".format, powers)]
    weights = result["wavelengths"], result["to_xyz"], result["to_rgb"]
    table = np.column_stack([*weights, *powers.values()])
    return [dict(zip(names, row, strict=True)) for row in table.tolist()]


def _print_tables(result: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> None:
    count = pluralise(result["count"], "wavelength")
    weights = {"wavelength": "nm", **dict(zip("XYZrgb", "XYZRGB", strict=True))}
    powers = {"wavelength": "nm"}
    powers |= {f"power {light}": light for light in result["powers"]}
    tables = {f"{count}, {result['method']}: weights": weights}
    tables["power of the lights"] = powers
    formats = {"wavelength": ".1f"}
    for title, headings in tables.items():
        Table(rows, headings, title, ".4f", formats).print_text()
        say()
    errors = [{"light": light, **row} for light, row in result["errors"].items()]
    headings = {"light": "light", "mean": "mean", "p95": "95 %", "max": "max"}
    title = f"ΔE00 of {pluralise(result['materials'], 'material')}"
    Table(errors, headings | {"worst": "worst material"}, title).print_text()
