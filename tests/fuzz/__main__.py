"""`make nightly`: every target with many inputs; the first one of each kind of failure
is kept in out/fuzz.
"""

import json
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

import click

from tests.fuzz.commands import COMMANDS, KEPT, run_target
from tests.fuzz.readers import READERS
from uplift.extras.timing import environment

BLOCK = 5000
"""Inputs per process. A new process releases leaked memory."""


@click.command()
@click.argument("names", nargs=-1, type=click.Choice([*READERS, *COMMANDS]))
@click.option(
    "--inputs",
    default=10_000,
    show_default=True,
    help="Inputs of each reader; a tenth of commands.",
)
@click.option("--seed", default=0, show_default=True)
def main(names: tuple[str, ...], inputs: int, seed: int) -> None:
    """Fuzz readers and commands, all by default, print what happened, and end with 1
    after a failure.
    """
    KEPT.mkdir(parents=True, exist_ok=True)
    rows = []
    with ProcessPoolExecutor(max_tasks_per_child=1) as pool:
        for name in names or (*READERS, *COMMANDS):
            count = inputs if name in READERS else inputs // 10
            blocks = [
                range(first, min(first + BLOCK, count))
                for first in range(0, count, BLOCK)
            ]
            tally = sum(
                pool.map(
                    run_target, [name] * len(blocks), [seed] * len(blocks), blocks
                ),
                Counter(),
            )
            if not tally["accepted"]:
                tally["no input accepted"] = 1
            row = {
                "target": name,
                "tried": count,
                "taken": tally.pop("accepted", 0),
                "refused": tally.pop("rejected", 0),
            }
            rows.append(
                row
                | {
                    "failures": ", ".join(
                        f"{times} {kind}" for kind, times in tally.items()
                    )
                    or "none"
                }
            )
            click.echo(
                (
                    "{target}: {tried:,} inputs, {taken:,} accepted, failures: "
                    "{failures}"
                ).format(**rows[-1])
            )
    figures = {
        "command": "make nightly",
        "environment": environment(),
        "seed": seed,
        "targets": rows,
    }
    (KEPT / "nightly.json").write_text(
        json.dumps(figures, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
    )
    raise SystemExit(any(row["failures"] != "none" for row in rows))


if __name__ == "__main__":
    main()
