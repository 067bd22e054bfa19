"""Shared basics of all layers: array types, errors, atomic file writing, CSV text, progress events, BLAS threads."""
