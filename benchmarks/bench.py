"""Timings of fits, processes, lookups and other tools: ``make bench`` writes docs/data/performance.json."""

from __future__ import annotations

import click

from benchmarks.processes import time_processes
from benchmarks.record import write


@click.command()
@click.option("--runs", default=5, show_default=True, help="Number of runs of each measurement.")
def main(runs: int) -> None:
    """Time the fit, processes, lookups and other tools."""
    # First: a process started from a large one counts the memory of its parent as its own.
    processes = time_processes(runs)
    from benchmarks import fitting, lookups, nodes, peers
    from benchmarks.peers.row import THRESHOLD

    cube = lookups.macbeth()
    write(
        "performance",
        "make bench",
        runs=runs,
        dims=fitting.time_dims(runs),
        models=fitting.time_models(runs),
        quadrature=nodes.quadrature_errors(),
        accelerators=fitting.time_accelerator(runs),
        processes=processes,
        lookups=lookups.time_lookups(cube, runs),
        bulk=lookups.time_bulk(cube, runs),
        threshold=THRESHOLD,
        peers=[peer.to_json() for peer in peers.time_peers(runs)],
    )


if __name__ == "__main__":
    main()
