"""Mixtures of paints, dyes, filters and lights in the spectral domain, and RGB
heuristics for comparison.

The theories are those of K. Fishkin, *Applying Color Science to Computer Graphics*,
Berkeley 1983, whose equation numbers the docstrings quote. Spectra have shape (..., N),
amounts (..., n), and the n spectra of a mixture (..., n, N). Leading axes broadcast.
docs/mixing.md has an example and results.
"""

from uplift.extras.paint.coats import Ingredients, Medium, make_coat, mix
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.overpaint import overpainter
from uplift.extras.paint.pigments import dispersive

__all__ = [
    "Ingredients",
    "Medium",
    "Surface",
    "dispersive",
    "make_coat",
    "mix",
    "overpainter",
]
