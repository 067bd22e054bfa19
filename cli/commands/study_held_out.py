"""``uplift study held-out``: errors on materials that a cube was not built from."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from ..inputs import DEFAULT_ATLASES, read_atlases
from ..options import Whole, atlas_option, coefficients_option, format_option
from ..output.console import make_table, print_csv, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.lab.study.held_out import HoldoutSplit

Results = dict[str, "tuple[HoldoutSplit, ...]"]


@click.command("held-out")
@atlas_option("Atlas", DEFAULT_ATLASES)
@click.option("--splits", type=Whole(1, 1000), default=3, show_default=True, help="Number of splits of each atlas.")
@click.option("--dim", type=Whole(), default=32, show_default=True, help="Lattice nodes along each axis.")
@coefficients_option
@format_option("table", "json", "csv")
def held_out(files: tuple[str, ...], splits: int, dim: int, coefficients: int, style: str) -> None:
    """Build cubes from half of an atlas, query the colours of the other half, and compare with the measurements.

    Reports the rms difference of the spectra and mean ΔE00 under A, FL2, FL7, FL11, LED-B3, LED-RGB1 and HP1, compared
    with cubes of moments and of sigmoids that have no atlas, and the predicted and the actual standard errors.
    The prior does not know the families of its library that contain spectra of the atlas.

    Two plain baselines know the same half: a local-linear regression of reflectance on RGB, and the centroid of the
    colours that mixtures of the known materials have under a light (Zhang, Funt & Mirzaei 2016).

    \b
    Examples:
      uplift study held-out --atlas paints.csv
      uplift study held-out --atlas rawtoaces --coefficients 17 --splits 10
      uplift study held-out --format json
    """
    enable_jit_cache()
    from uplift.lab.study.held_out import holdout

    results: Results = {}
    for name, atlas in read_atlases(files).items():
        with progress_bar(name) as progress:
            results[name] = holdout(atlas, splits, progress, dim=dim, coefficients=coefficients)
    PRINTERS[style](results)


def _records(results: Results) -> list[dict[str, Any]]:

    import numpy as np

    from uplift.colorimetry.lights import HELD_OUT_LIGHTS
    from uplift.lab.study.held_out import pooled_calibration

    records: list[dict[str, Any]] = []
    for name, splits in results.items():
        for method in splits[0].errors:
            rms, *delta_e = np.mean([split.errors[method].means() for split in splits], axis=0).tolist()
            record = {"atlas": name, "cube": method, "colours": len(splits[0].actual)}
            record["rms"] = None if np.isnan(rms) else rms
            records.append(record | dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True)))
        errors = pooled_calibration(splits)
        records[-len(splits[0].errors)]["standard_error"] = errors and errors.to_json()
    return records


def _print_json(results: Results) -> None:
    print_json(_records(results))


def _print_csv(results: Results) -> None:
    from uplift.colorimetry.lights import HELD_OUT_LIGHTS

    header = ["atlas", "cube", "colours", "rms", *HELD_OUT_LIGHTS]
    rows = ([record[key] for key in header] for record in _records(results))
    print_csv(header, rows)


def _print_table(results: Results) -> None:

    from uplift.colorimetry.lights import HELD_OUT_LIGHTS

    table = make_table(("atlas", "cube"), ("rms", *HELD_OUT_LIGHTS))
    standard_errors = []
    for record in _records(results):
        rms = "" if record["rms"] is None else f"{record['rms']:.4f}"
        cells = [rms, *(f"{record[light]:.3f}" for light in HELD_OUT_LIGHTS)]
        table.add_row(record["atlas"], record["cube"], *cells)
        if record.get("standard_error"):
            standard_errors.append((record["atlas"], record["standard_error"]))
    show(table)
    for name, errors in standard_errors:
        say(
            f"{name}: predicted standard error ΔE00 {errors['stated']:.2f}, actual {errors['real']:.2f}; "
            f"{errors['within_error']:.0%} within it, {errors['within_bound']:.0%} within the error bound"
        )


PRINTERS: dict[str, Callable[[Results], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
