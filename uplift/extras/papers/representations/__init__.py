"""Spectral representations for renderers, and their comparison by error and cost.

Kment 2011, "Spectral data representation techniques for realistic image synthesis",
thesis, Vienna. Abbreviations, sections and equations in this package refer to it.
"""
