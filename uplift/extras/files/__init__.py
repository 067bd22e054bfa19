"""Files of people: CSV, TOML and JSON, and what a program checks before it writes.

Tables of spectra are in `uplift.extras.formats`, images in `uplift.extras.images`,
cubes in `uplift.cube`.
"""
