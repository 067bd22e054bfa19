"""Timings, outside the tests: ``make bench`` writes docs/performance.md and docs/performance.json."""
