"""What a build says when it is done."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from uplift.cube import CubeData
    from uplift.lookup import Cube


def tell_improvements(cube: Cube) -> None:
    for step in cube.data.provenance["improvements"]:
        click.echo(f"improvement, {step['step']}: tried {step['tried']}, mended {step['mended']}", err=True)


def tell(cube: Cube, path: Path, seconds: float) -> None:
    from uplift.lattice import Status

    data, counts = cube.data, cube.data.points.counts()
    missed, beyond = counts["unfitted"], counts["unrealisable"]
    within = f"all within {data.threshold:g}"
    fitted = within if not missed else f"{missed} MISS the threshold {data.threshold:g}"
    if beyond:
        fitted += f" but {beyond} that no reflectance has the colour of: these have less chroma"
    worst = data.points.distance[data.points.status != Status.UNREALISABLE].max(initial=0)
    entries = f"{len(data.atlas.names)} atlas entries, " if data.provenance["atlases"] else ""
    click.echo(
        f"{path}: {_points(data)}, {entries}{fitted} (worst {worst:.1e}), "
        f"{counts['improved']} improved, {path.stat().st_size / 1e6:.1f} MB, {seconds:.1f} s"
    )


def _points(data: CubeData) -> str:
    if data.complete_cells is None:
        return f"{data.lattice.size} points"
    there = int(data.points.present.sum())
    return f"{there} of {data.lattice.size} points ({there / data.lattice.size:.1%})"
