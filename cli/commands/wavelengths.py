"""``uplift wavelengths``: choose the wavelengths of a renderer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from uplift.common.text import pluralise

from .. import options
from ..inputs import DEFAULT_ATLASES, atlas_files, check_range, read_atlases
from ..output.console import make_table, print_csv, print_json, say, show
from ..output.progress import progress_bar
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry import Sensor
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.scene.wavelengths import Choice


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
      uplift wavelengths --count 8
      uplift wavelengths --tolerance 1 --light D65 --light FL11 --plot chosen.png
      uplift wavelengths --tolerance 0.5 --measure p95 --atlas paints.csv
      uplift wavelengths --wavelengths 400:700:20 --light A --format csv
      uplift wavelengths --count 4 --method meyer --light C --atlas macbeth
      uplift wavelengths --orders 3 2 1 --light C --atlas macbeth
    """,
)
@click.option(
    "--count", metavar="N", type=options.WHOLE, help="Number of wavelengths, 1 to 40."
)
@options.tolerance(help="Choose the fewest wavelengths with an error below this ΔE00.")
@options.wavelengths("; only their weights and powers are fitted.")
@click.option(
    "--measure",
    type=click.Choice(("mean", "p95", "max")),
    help="Statistic of --tolerance over all materials and lights. [default: max]",
)
@click.option(
    "--method",
    type=click.Choice(("optimised", "meyer", "uniform", "bins", "fitted")),
    help="optimised: fit everything; meyer: Meyer's quadrature; the others use even "
    "wavelengths, sampled (uniform), "
    "averaged over bins (bins) or with fitted weights (fitted). [default: optimised]",
)
@click.option(
    "--orders",
    nargs=3,
    metavar="A C1 C2",
    type=options.WHOLE,
    help=(
        "Meyer's quadrature with these numbers of wavelengths for the three "
        "channels, 1 to 10 each."
    ),
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
@options.sensor
@options.output_format("table", "json", "csv")
@options.plot("Plot lights, wavelengths and weights")
@options.force
def command(
    count: int | None,
    tolerance: float | None,
    wavelengths: Array | None,
    measure: str | None,
    method: str | None,
    orders: tuple[int, int, int] | None,
    channels: str | None,
    files: tuple[str, ...],
    lights: tuple[Illuminant, ...],
    style: str,
    plot_path: str | None,
    force: bool,
    **camera: Any,
) -> None:
    ways = (count, tolerance, wavelengths, orders)
    if sum(way is not None for way in ways) != 1:
        raise click.UsageError(
            "Give one of --count, --tolerance, --wavelengths and --orders."
        )
    is_searched = count is not None or tolerance is not None
    if (measure and tolerance is None) or (method and not is_searched):
        raise click.UsageError(
            "--measure requires --tolerance, --method requires --count or --tolerance."
        )
    if channels and orders is None:
        raise click.UsageError("--channels requires --orders.")
    from uplift.atlas import merge, on_grid
    from uplift.colorimetry import observer
    from uplift.extras.scene import wavelengths as library

    check_outputs(plot_path, inputs=atlas_files(files))
    observer.require_observer(camera["observer"], "weights of wavelengths")
    sensor = observer.sensor(**camera)
    atlas = merge(read_atlases(files).values())
    setting = library.make_setup(
        on_grid(atlas, library.grid()),
        lights or ("D65",),
        observer_name=camera["observer"],
    )
    if wavelengths is not None:
        check_range(wavelengths, library.grid())
        fit = partial(library.fit_weights, setting, wavelengths)
    elif orders is not None:
        fit = partial(library.choose_orders, setting, orders, channels or "opponent")
    else:
        fit = partial(
            library.choose,
            setting,
            count=count,
            target=tolerance,
            measure=measure or "max",
            method=method or "optimised",
        )
    with progress_bar("fitting wavelengths"):
        choice = fit()
    if plot_path is not None:
        from uplift.extras.scene.wavelengths.plots import plot_choice

        plot_choice(setting, choice, plot_path, force=force)
        say(f"{plot_path}: lights, wavelengths and weights", err=True)
    _print(choice, sensor, atlas.names, style)


def _print(
    choice: Choice, camera: Sensor, materials: tuple[str, ...], style: str
) -> None:
    import numpy as np

    from uplift.extras.scene.wavelengths.sampling import statistics

    sampling = choice.sampling
    to_rgb = sampling.to_rgb(camera)
    by_light = dict(zip(sampling.lights, choice.errors, strict=True))
    if len(by_light) > 1:
        by_light["all lights"] = choice.errors
    errors = {}
    for name, values in by_light.items():
        worst = materials[values.argmax() % len(materials)]
        errors[name] = {**statistics(values), "worst": worst}
    # wavelength, weights to XYZ and to RGB, and powers of the lights
    rows = np.column_stack(
        [sampling.wavelengths, sampling.to_xyz, to_rgb, sampling.powers.T]
    ).tolist()
    if style == "json":
        fields = {
            "method": choice.method,
            "count": len(sampling),
            "materials": len(materials),
            "observer": camera.observer,
            "space": camera.space,
            "illuminant": camera.illuminant,
            "wavelengths": sampling.wavelengths.tolist(),
            "to_xyz": sampling.to_xyz.tolist(),
            "to_rgb": to_rgb.tolist(),
            "powers": dict(zip(sampling.lights, sampling.powers.tolist(), strict=True)),
            "errors": errors,
        }
        print_json(fields)
    elif style == "csv":
        powers = [f"power {light}" for light in sampling.lights]
        print_csv(["wavelength", *"XYZ", *"rgb", *powers], rows)
    else:
        title = f"{pluralise(len(sampling), 'wavelength')}, {choice.method}: weights"
        _print_tables(sampling.lights, rows, errors, title, len(materials))


def _print_tables(
    lights: Sequence[str],
    rows: Sequence[Sequence[float]],
    errors: Mapping[str, Mapping[str, Any]],
    title: str,
    materials: int,
) -> None:
    weights = make_table((), ("nm", *"XYZRGB"), title=title)
    powers = make_table((), ("nm", *lights), title="power of the lights")
    for nm, *others in rows:
        cells = [f"{other:.4f}" for other in others]
        weights.add_row(f"{nm:.1f}", *cells[:6])
        powers.add_row(f"{nm:.1f}", *cells[6:])
    table = make_table(
        ("light",),
        ("mean", "95 %", "max"),
        title=f"ΔE00 of {pluralise(materials, 'material')}",
    )
    table.add_column("worst material")
    for name, row in errors.items():
        *numbers, worst = row.values()
        table.add_row(name, *[f"{number:.3f}" for number in numbers], worst)
    show(weights, powers, table)
