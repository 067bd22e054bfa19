"""Name and version of the distribution, read from the source: the package index has another project `uplift`."""

DISTRIBUTION = "spectral-uplift"
"""Name on the package index."""
VERSION = "0.2.0"
"""Version of this source; `pyproject.toml` reads it."""
