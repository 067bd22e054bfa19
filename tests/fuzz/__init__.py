"""Fuzzing programs, one module per target, and their tests. `make nightly` runs them with many inputs.

Accepted input must be usable. Rejected input must raise an `UpliftError` of one line. Anything else is a failure.
Results are written to docs/data/stability-hostile.json.
"""
