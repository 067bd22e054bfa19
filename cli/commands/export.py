"""``uplift export``: a cube for other tools."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.progress import spinner
from ..params.options import fill_option, force_option

if TYPE_CHECKING:
    from uplift.cube import CubeData

SUFFIXES = {"coeff": ".coeff", "c": ".h", "npz": ".npz", "csv": ".csv"}


@click.command("export")
@click.argument("cube", metavar="CUBE", type=click.Path())
@click.argument("out", metavar="[OUT]", required=False, type=click.Path())
@click.option("--to", "to", type=click.Choice(tuple(SUFFIXES)), help="Format. [default: as OUT is called]")
@click.option("--res", type=int, help="Points along each axis of a coeff table. [default: 64]")
@fill_option()
@force_option()
def command(cube: str, out: str | None, to: str | None, res: int | None, fill: bool, force: bool) -> None:
    """Write a cube in a format that other tools read.

    coeff, the table of rgb2spec that Mitsuba and colour-science read: sigmoid spectra of the cube's colours.
    Three numbers a spectrum have no room for what an atlas tells.

    c, one C99 header, which C++ takes too: the table, and functions that look up and evaluate its spectra as
    'uplift query --mode moments' does. Its names begin with the file's.

    npz, all arrays of the cube by name, for numpy; csv, a line for every lattice point.

    Without OUT it has the cube's name, in this folder.

    \b
    Examples:
      uplift export macbeth-32.uplift macbeth-32.npz
      uplift export macbeth-32.uplift data/srgb.coeff
      uplift export macbeth-32.uplift cube.h
      uplift export macbeth-32.uplift --to csv
    """
    to = to or _format_of(out)
    if res is not None and to != "coeff":
        raise click.UsageError("--res is for --to coeff alone: other formats keep the cube's own points.")
    out = out or Path(cube).stem + SUFFIXES[to]
    if os.path.realpath(out) == os.path.realpath(cube):
        raise click.UsageError("OUT is the cube itself.")
    from uplift.common.files import check_output
    from uplift.lookup import load

    path = check_output(out, force=force)
    options = {} if res is None else {"res": res}
    asked = load(cube).fill_missing() if fill else load(cube)
    click.echo(f"{path}: {WRITERS[to](asked.data, path, force=force, **options)}")


def _format_of(out: str | None) -> str:
    """The format that a file's name stands for."""
    for name, suffix in SUFFIXES.items():
        if out is not None and Path(out).suffix.lower() == suffix:
            return name
    raise click.UsageError(f"Name a format: --to, or OUT ending in {', '.join(SUFFIXES.values())}.")


def _coeff(data: CubeData, path: Path, **options: Any) -> str:
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.io.export import write_coeff

    with spinner("fitting sigmoids"):
        worst = write_coeff(data, path, **options)
    return f"sigmoids for rgb2spec's readers, colours within {worst:.1e}"


def _c(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_c

    size = write_c(data, path, **options)
    return (
        f"C99 header, {data.lattice.size} points, {len(data.atlas.names)} atlas entries, {size / 1e6:.1f} MB"
    )


def _npz(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_npz

    return f"{write_npz(data, path, **options)} arrays"


def _csv(data: CubeData, path: Path, **options: Any) -> str:
    from uplift.io.export import write_csv

    return f"{write_csv(data, path, **options)} lattice points"


WRITERS: dict[str, Callable[..., str]] = {"coeff": _coeff, "c": _c, "npz": _npz, "csv": _csv}
