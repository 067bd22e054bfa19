"""Cubes and emission tables in the formats of other programs: the registry of formats,
a module for each kind of format, and the sources of programs in ``source/``.

Textures are in `uplift.extras.texture`, pages in `uplift.extras.report`, and what a
program of paints computes in `uplift.extras.paint`.
"""
