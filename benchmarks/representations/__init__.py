"""Comparison of spectral representations with Kment 2011: docs/data/representations.json."""
