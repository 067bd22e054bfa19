"""`make nightly`: every target with many inputs; those that fail are kept in out/fuzz."""

from __future__ import annotations

import json
import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from tests.fuzz.campaign import Tally
from tests.fuzz.targets import COMMANDS, KEPT, READERS, fuzz_target
from uplift.lab.timing import environment

BLOCK = 5000
"""Inputs per process. A new process releases leaked memory."""


@click.command()
@click.option("--inputs", default=10_000, show_default=True, help="Inputs of each reader; a tenth of commands.")
@click.option("--target", "chosen", multiple=True, type=click.Choice([*READERS, *COMMANDS]), help="All by default.")
@click.option("--seed", default=0, show_default=True)
@click.option("--processes", default=os.cpu_count(), show_default=True)
@click.option("-o", "--output", default=KEPT / "nightly.json", show_default=True, type=click.Path(path_type=Path))
def main(inputs: int, chosen: tuple[str, ...], seed: int, processes: int, output: Path) -> None:
    """Fuzz readers and commands, print what happened, and end with 1 after a failure."""
    KEPT.mkdir(parents=True, exist_ok=True)
    counts = dict.fromkeys(READERS, inputs) | dict.fromkeys(COMMANDS, inputs // 10)
    counts = {name: counts[name] for name in chosen or counts}
    blocks = [
        (name, range(first, min(first + BLOCK, count)))
        for name, count in counts.items()
        for first in range(0, count, BLOCK)
    ]
    tallies = {name: Tally(name) for name in counts}
    with ProcessPoolExecutor(processes, max_tasks_per_child=1) as pool:
        for tally in pool.map(fuzz_target, [seed] * len(blocks), *zip(*blocks, strict=True)):
            tallies[tally.target].add(tally)
    rows = [
        {"target": tally.target, "tried": tally.inputs, "taken": tally.accepted, "refused": tally.rejected}
        | {"failures": ", ".join(f"{count} {kind}" for kind, count in tally.failures.items()) or "none"}
        for tally in tallies.values()
    ]
    figures = {"command": "make nightly", "environment": environment(), "seed": seed, "targets": rows}
    output.write_text(json.dumps(figures, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    for row in rows:
        click.echo("{target}: {tried:,} inputs, {taken:,} accepted, failures: {failures}".format(**row))
    raise SystemExit(any(tally.failures for tally in tallies.values()))


if __name__ == "__main__":
    main()
