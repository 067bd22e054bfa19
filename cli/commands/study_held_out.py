"""``uplift study held-out``: what a cube makes of materials that it has not seen."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from ..output.console import console, json_text
from ..output.progress import progress_bar
from ..params.options import format_option
from ..params.study_atlases import SHIPPED, read_each

if TYPE_CHECKING:
    from uplift.lab.study.held_out import HoldoutSplit

Found = dict[str, "tuple[HoldoutSplit, ...]"]


@click.command("held-out")
@click.option(
    "--atlas", "files", metavar="FILE", multiple=True, help=f"Atlas; may be repeated. [default: {SHIPPED}]"
)
@click.option("--splits", default=3, show_default=True, help="Ways to halve each atlas.")
@click.option("--dim", default=32, show_default=True, help="Lattice points along each axis.")
@click.option("--moments", default=8, show_default=True, help="Moments per spectrum, 2 to 16.")
@format_option("table", "json", "csv")
def held_out(files: tuple[str, ...], splits: int, dim: int, moments: int, style: str) -> None:
    """Build cubes from half of an atlas, ask them for the other half, and compare with the measurements.

    Beside them stand cubes without an atlas, of moments and of sigmoids: rms over the spectrum, and mean ΔE00 under
    A, FL2, FL7, FL11, LED-B3, LED-RGB1 and HP1. Then the standard errors that the cubes state, and the real ones.

    \b
    Examples:
      uplift study held-out --atlas paints.csv
      uplift study held-out --atlas atlases/rawtoaces.txt --moments 16 --splits 10
      uplift study held-out --format json
    """
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.lab.study.held_out import holdout

    atlases = read_each(files)
    found: Found = {}
    for name, spectra in atlases.items():
        with progress_bar(name) as progress:
            found[name] = holdout(spectra, splits, progress, dim=dim, coefficients=moments + 1)
    PRINTERS[style](found)


def _records(found: Found) -> list[dict[str, Any]]:
    from dataclasses import asdict

    import numpy as np

    from uplift.colorimetry.lights import HELD_OUT_LIGHTS
    from uplift.lab.study.held_out import pooled_calibration

    records: list[dict[str, Any]] = []
    for name, splits in found.items():
        for method in splits[0].errors:
            rms, *delta_e = np.mean([split.errors[method].means() for split in splits], axis=0).tolist()
            record = {"atlas": name, "cube": method, "colours": len(splits[0].real), "rms": rms}
            records.append(record | dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True)))
        said = pooled_calibration(splits)
        records[-len(splits[0].errors)]["standard_error"] = said and asdict(said)
    return records


def _print_json(found: Found) -> None:
    click.echo(json_text(_records(found)))


def _print_csv(found: Found) -> None:
    from uplift.colorimetry.lights import HELD_OUT_LIGHTS

    text = io.StringIO()
    writer = csv.DictWriter(
        text,
        ["atlas", "cube", "colours", "rms", *HELD_OUT_LIGHTS],
        extrasaction="ignore",
        lineterminator="\n",
    )
    writer.writeheader()
    writer.writerows(_records(found))
    click.echo(text.getvalue(), nl=False)


def _print_table(found: Found) -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from uplift.colorimetry.lights import HELD_OUT_LIGHTS

    table = Table(box=box.SIMPLE_HEAD)
    for heading in ("atlas", "cube"):
        table.add_column(heading, no_wrap=True)
    for heading in ("rms", *HELD_OUT_LIGHTS):
        table.add_column(heading, justify="right", no_wrap=True)
    sayings = []
    for record in _records(found):
        cells = [f"{record['rms']:.4f}", *(f"{record[light]:.3f}" for light in HELD_OUT_LIGHTS)]
        table.add_row(Text(record["atlas"]), record["cube"], *cells)
        if record.get("standard_error"):
            sayings.append((record["atlas"], record["standard_error"]))
    console().print(table)
    for name, said in sayings:
        click.echo(
            f"{name}: stated standard error ΔE00 {said['stated']:.2f}, real {said['real']:.2f}; "
            f"{said['within_one']:.0%} within one, {said['within_two']:.0%} within two"
        )


PRINTERS: dict[str, Callable[[Found], None]] = {
    "table": _print_table,
    "json": _print_json,
    "csv": _print_csv,
}
