"""Fuzzing (`make nightly`): accepted input is usable, rejected input raises an
`UpliftError` of one line.
"""
