"""Measure, then write the page."""

from __future__ import annotations

from benchmarks.stability import measure, write

if __name__ == "__main__":
    measure.main()
    write.main()
