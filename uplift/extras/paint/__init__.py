"""Mixtures of paints, dyes, filters and lights in the spectral domain, measured paints
with their recipes, mixers of RGB for programs, and RGB heuristics for comparison.

Not here: files of spectra (`uplift.extras.formats`), images other than the coat that is
painted over them (`uplift.extras.images`), and palettes (`uplift.extras.papers`).
Measured paints are fitted by `fit_paints` (docs/guides/paints.md). The theories are
those of K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, whose
equation numbers the docstrings quote. Spectra have shape (..., N), amounts (..., n),
and the n spectra of a mixture (..., n, N). Leading axes broadcast. docs/mixing.md has
an example and results.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
