"""Version, read from the source: the package index has another project `uplift`."""

VERSION = "0.2.0"
"""Version of this source; `pyproject.toml` reads it."""
