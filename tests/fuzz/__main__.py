"""``make nightly``: every target under many inputs → docs/stability-hostile.json."""

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
    tallies = list(found.values())
    Path(output).write_text(json.dumps(_tables(tallies, seed), indent=1) + "\n", encoding="utf-8")
    for tally in tallies:
        click.echo(f"{tally.target}: {', '.join(_cells(tally)[1:])}")
    raise SystemExit(any(tally.failures for tally in tallies))


def _tables(tallies: list[Tally], seed: int) -> list[dict[str, object]]:
    """For docs/stability.md, as `benchmarks.stability` has it."""
    facts = environment()
    return [
        {
            "title": "Hostile input, killed writers, full disks",
            "command": "make nightly",
            "columns": ["target", "tried", "taken", "refused", "failures"],
            "rows": [_cells(tally) for tally in tallies],
            "notes": [
                "Readers get files and texts spoilt by seeded mutation; what they take is used, what they refuse is "
                "one line. Nothing else may happen, nor take longer than some seconds or much more memory than the "
                "file. Writers are killed, raced and stranded: then there is the old file or a whole new one.",
                f"Seed {seed}; {facts['machine']}; commit {facts['commit']}.",
            ],
        },
        {
            "title": "What hostile input found",
            "command": "make nightly",
            "columns": list(FOUND[0]),
            "rows": [list(case.values()) for case in FOUND],
            "notes": ["Kept by hand, as runs show nothing of what is mended."],
        },
    ]


def _cells(tally: Tally) -> list[str]:
    failures = ", ".join(f"{count} {kind}" for kind, count in tally.failures.items()) or "none"
    answers = [f"{count:,}" if tally.taken or tally.refused else "" for count in (tally.taken, tally.refused)]
    return [tally.target, f"{tally.inputs:,}", *answers, failures]


if __name__ == "__main__":
    main()
