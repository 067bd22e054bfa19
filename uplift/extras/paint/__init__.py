"""Mixtures of paints, dyes, filters and lights in the spectral domain, measured paints
with their recipes, and RGB heuristics for comparison.

Measured paints are fitted by `fit_paints` (docs/guides/paints.md). The theories are
those of K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, whose
equation numbers the docstrings quote. Spectra have shape (..., N), amounts (..., n),
and the n spectra of a mixture (..., n, N). Leading axes broadcast. docs/mixing.md has
an example and results.
"""

from uplift.extras.paint.coats import Ingredients, Medium, make_coat, mix
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.overpaint import overpainter
from uplift.extras.paint.paint_advice import PaintAdvice, advise_samples
from uplift.extras.paint.paint_fit import PaintFit, fit_paints
from uplift.extras.paint.paint_samples import PaintSamples, read_paint_samples
from uplift.extras.paint.paints import Paints, strengths
from uplift.extras.paint.paints_file import read_paints, write_paints
from uplift.extras.paint.pigments import dispersive
from uplift.extras.paint.recipes import PaintRecipe, PaintTarget, match

__all__ = [
    "Ingredients",
    "Medium",
    "PaintAdvice",
    "PaintFit",
    "PaintRecipe",
    "PaintSamples",
    "PaintTarget",
    "Paints",
    "Surface",
    "advise_samples",
    "dispersive",
    "fit_paints",
    "make_coat",
    "match",
    "mix",
    "overpainter",
    "read_paint_samples",
    "read_paints",
    "strengths",
    "write_paints",
]
