"""Failures of fits and sensitivity of cubes: ``make stability`` writes docs/data/stability.json."""
