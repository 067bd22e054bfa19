"""Palettes: lights and materials designed for the colours that they must produce
together (docs/palette.md).

Sections and equations are those of S. Bergner, T. Möller, M. S. Drew, *A Spectral
Engine for Visualization*, 2004.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
