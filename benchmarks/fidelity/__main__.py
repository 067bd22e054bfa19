"""Accuracy of cubes against measured spectra, and the measurements behind the design: ``make study``.

Writes docs/data/fidelity.json.
"""

from __future__ import annotations

import sys
import time
from typing import Any

from benchmarks.fidelity import between, crowding, cubes, light_errors, loss, seeds, start
from benchmarks.record import write


def main() -> None:
    """Measure and store."""
    figures: dict[str, Any] = {}
    for part in (seeds, start, between, loss, cubes, light_errors, crowding):
        begin = time.perf_counter()
        figures |= part.measure()
        print(f"{part.__name__}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    write("fidelity", "make study", **figures)


if __name__ == "__main__":
    main()
