"""``make nightly``: every target under many inputs → docs/data/stability-hostile.json."""

from __future__ import annotations

import json
import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from tests.fuzz.attack import Tally
from tests.fuzz.known_findings import FOUND
from tests.fuzz.run import KEPT, TARGETS, WRITERS, add, read, write
from uplift.lab.timing import environment

BLOCK = 5000
"""Inputs that a process tries before another takes over: what leaks shows, and is gone."""


@click.command()
@click.option("--inputs", default=100_000, show_default=True, help="Inputs of each reader.")
@click.option(
    "--writers", "kills", default=120, show_default=True, help="Killed, racing and stranded writers."
)
@click.option("--seed", default=0, show_default=True, help="Another seed tries other inputs.")
@click.option("--processes", default=os.cpu_count(), show_default=True)
@click.option("-o", "--output", default="docs/data/stability-hostile.json", show_default=True)
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
    tallies = list(found.values())
    figures = {
        "command": "make nightly",
        "environment": environment(),
        "seed": seed,
        "targets": [_record(tally) for tally in tallies],
        "findings": FOUND,
    }
    Path(output).write_text(json.dumps(figures, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    for tally in tallies:
        click.echo(f"{tally.target}: {tally.inputs:,} tried, failures: {_failures(tally)}")
    raise SystemExit(any(tally.failures for tally in tallies))


def _record(tally: Tally) -> dict[str, object]:
    """Return a row of docs/data/stability-hostile.json."""
    reads = bool(tally.taken or tally.refused)
    return {
        "target": tally.target,
        "tried": tally.inputs,
        "taken": tally.taken if reads else None,
        "refused": tally.refused if reads else None,
        "failures": _failures(tally),
    }


def _failures(tally: Tally) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in tally.failures.items()) or "none"


if __name__ == "__main__":
    main()
