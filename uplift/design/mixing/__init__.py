"""Mixtures of paints, dyes, filters and lights in the spectral domain, and RGB heuristics for comparison.

The theories are those collected by K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, chapters 5
and 7–10, whose equation numbers the docstrings quote. docs/mixing.md shows results. Spectra have shape (..., N),
amounts (..., n), and the n spectra of a mixture (..., n, N). Leading axes broadcast.

Examples
--------
::

    from uplift.design.mixing import Ingredients, Medium, dispersive, mix

    paints = Ingredients(cube.reflectance([blue, yellow]))
    medium = Medium(scattering=dispersive(cube.data.sensor))
    mix("pigment", paints, [2, 1], medium, ground=1.0)  # two parts of blue, one part of yellow
"""

from __future__ import annotations

from uplift.design.mixing.coats import Coat, Ingredients, Medium, make_coat, mix, ramp
from uplift.design.mixing.layers import Surface
from uplift.design.mixing.overpaint import overpainter
from uplift.design.mixing.pigments import dispersive
from uplift.design.mixing.theories import Mixer, mixers

__all__ = [
    "Coat",
    "Ingredients",
    "Medium",
    "Mixer",
    "Surface",
    "dispersive",
    "make_coat",
    "mix",
    "mixers",
    "overpainter",
    "ramp",
]
