"""``make hostile`` and ``make nightly``: run every target with many inputs → docs/data/stability-hostile.json."""

from __future__ import annotations

import json
import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click

from tests.fuzz.campaign import Tally
from tests.fuzz.known_findings import KNOWN_FINDINGS
from tests.fuzz.run import COMMANDS, KEPT, TARGETS, WRITERS, fuzz_target, stress_writer
from uplift.lab.timing import environment

BLOCK = 5000
"""Inputs per process. A new process releases leaked memory."""


@click.command()
@click.option("--inputs", default=100_000, show_default=True, help="Inputs of each reader.")
@click.option("--commands", default=10_000, show_default=True, help="Runs of the command line of each class.")
@click.option("--writers", "runs", default=120, show_default=True, help="Runs of the tests of writers.")
@click.option("--target", "chosen", multiple=True, help="Class to run, and to replace in the output; all by default.")
@click.option("--seed", default=0, show_default=True, help="Seed of the inputs.")
@click.option("--processes", default=os.cpu_count(), show_default=True)
@click.option("-o", "--output", default="docs/data/stability-hostile.json", show_default=True)
def main(
    inputs: int,
    commands: int,
    runs: int,
    chosen: tuple[str, ...],
    seed: int,
    processes: int,
    output: str,
) -> None:
    """Fuzz every reader and the command line, stress every writer; inputs that fail are kept in out/fuzz."""
    KEPT.mkdir(parents=True, exist_ok=True)
    counts = dict.fromkeys(TARGETS, inputs) | dict.fromkeys(COMMANDS, commands)
    counts = {name: count for name, count in counts.items() if name in (chosen or counts)}
    blocks = [
        (name, range(first, min(first + BLOCK, count)))
        for name, count in counts.items()
        for first in range(0, count, BLOCK)
    ]
    by_target = {name: Tally(name) for name in counts}
    with ProcessPoolExecutor(processes, max_tasks_per_child=1) as pool:
        for tally in pool.map(fuzz_target, [seed] * len(blocks), *zip(*blocks, strict=True)):
            by_target[tally.target].add(tally)
    tallies = [
        *by_target.values(),
        *(
            stress_writer(test, max(runs // divisor, 1), seed)
            for name, (test, divisor) in WRITERS.items()
            if name in (chosen or WRITERS)
        ),
    ]
    _write(Path(output), tallies, seed)
    for tally in tallies:
        click.echo(f"{tally.target}: {tally.inputs:,} inputs, failures: {_failures(tally)}")
    raise SystemExit(any(tally.failures for tally in tallies))


def _write(path: Path, tallies: list[Tally], seed: int) -> None:
    """Write the rows of classes, and keep the other rows of the file."""
    here = environment()
    commit = here.pop("commit")
    old = json.loads(path.read_text(encoding="utf-8"))["targets"] if path.exists() else []
    rows = {row["target"]: row for row in old} | {
        tally.target: _record(tally) | {"commit": commit} for tally in tallies
    }
    figures = {
        "command": "make hostile",
        "environment": here,
        "seed": seed,
        "targets": [rows[name] for name in (*TARGETS, *COMMANDS, *WRITERS) if name in rows],
        "findings": KNOWN_FINDINGS,
    }
    path.write_text(json.dumps(figures, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _record(tally: Tally) -> dict[str, object]:
    """Make a row of docs/data/stability-hostile.json."""
    is_reader = tally.target in TARGETS | COMMANDS
    return {
        "target": tally.target,
        "tried": tally.inputs,
        "taken": tally.accepted if is_reader else None,
        "refused": tally.rejected if is_reader else None,
        "failures": _failures(tally),
    }


def _failures(tally: Tally) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in tally.failures.items()) or "none"


if __name__ == "__main__":
    main()
