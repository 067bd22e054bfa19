"""``make nightly``: every target under many inputs → docs/stability-hostile.json."""

from __future__ import annotations

import json
import os
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path

import click

from hostile.attack import Tally
from hostile.found import FOUND
from hostile.run import KEPT, TARGETS, WRITERS, add, read, write
from uplift.timing import circumstances

BLOCK = 5000
"""Inputs that a process tries before another takes over: what leaks shows, and is gone."""


@click.command()
@click.option("--inputs", default=100_000, show_default=True, help="Inputs of each reader.")
@click.option(
    "--writers", "kills", default=120, show_default=True, help="Killed, racing and stranded writers."
)
@click.option("--seed", default=0, show_default=True, help="Another seed tries other inputs.")
@click.option("--processes", default=os.cpu_count(), show_default=True)
@click.option("-o", "--output", default="docs/stability-hostile.json", show_default=True)
def main(inputs: int, kills: int, seed: int, processes: int, output: str) -> None:
    """Attack every reader and writer; what is not refused cleanly is kept in out/hostile."""
    KEPT.mkdir(parents=True, exist_ok=True)
    blocks = [
        (name, range(first, min(first + BLOCK, inputs)))
        for first in range(0, inputs, BLOCK)
        for name in TARGETS
    ]
    found = {name: Tally(name) for name in TARGETS}
    with ProcessPoolExecutor(processes, max_tasks_per_child=1) as pool:
        for tally in pool.map(read, [seed] * len(blocks), *zip(*blocks, strict=True)):
            add(found[tally.target], tally)
    for target, share in WRITERS:
        tally = write(target, max(kills // share, 1), seed)
        found[tally.target] = tally
    rows = [asdict(tally) | {"failures": dict(tally.failures)} for tally in found.values()]
    facts = circumstances() | {"seed": seed, "rows": rows, "found": FOUND}
    Path(output).write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    for row in rows:
        click.echo(
            f"{row['target']}: {row['inputs']} tried, {row['taken']} taken, {row['refused']} refused",
            nl=False,
        )
        click.echo(f", failures: {row['failures'] or 'none'}")
    raise SystemExit(any(row["failures"] for row in rows))


if __name__ == "__main__":
    main()
