"""`make nightly`: every target with many inputs; the first one of each kind of failure
is kept in out/fuzz.
"""

import json
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

from tests.fuzz.commands import COMMANDS, KEPT, run_target
from tests.fuzz.readers import READERS
from uplift.extras.timing import environment

BLOCK = 5000
"""Inputs per process. A new process releases leaked memory."""


def main(inputs: int = 10_000, *names: str) -> int:
    """Fuzz readers, and commands with a tenth of the inputs, all by default; print and
    write what happened, and return the number of targets that failed.
    """
    KEPT.mkdir(parents=True, exist_ok=True)
    rows = []
    with ProcessPoolExecutor(max_tasks_per_child=1) as pool:
        for name in names or (*READERS, *COMMANDS):
            count = inputs if name in READERS else inputs // 10
            blocks = [range(count)[at : at + BLOCK] for at in range(0, count, BLOCK)]
            tally = sum(pool.map(run_target, [name] * len(blocks), blocks), Counter())
            row = {"target": name, "tried": count, "taken": tally.pop("accepted", 0)}
            row["refused"] = tally.pop("rejected", 0)
            if not row["taken"]:
                tally["no input accepted"] = 1
            row["failures"] = ", ".join(map(str, tally.items())) or "none"
            rows.append(row)
            print(row, flush=True)
    figures = {"command": "make nightly", "environment": environment(), "targets": rows}
    text = json.dumps(figures, indent=1, ensure_ascii=False)
    (KEPT / "nightly.json").write_text(text + "\n", encoding="utf-8")
    return sum(row["failures"] != "none" for row in rows)


if __name__ == "__main__":
    sys.exit(bool(main(*map(int, sys.argv[1:2]), *sys.argv[2:])))
