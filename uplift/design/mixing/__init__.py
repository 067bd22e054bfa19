"""Mixtures of paints, dyes, filters and lights in the spectral domain, and RGB heuristics for comparison.

Each module implements one theory; most follow K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley
1983, chapters 5 and 7–10, whose equation numbers the docstrings quote. docs/mixing.md shows results. Spectra have shape
(..., N), amounts (..., n), and the n spectra of a mixture (..., n, N). Leading axes broadcast.

Examples
--------
::

    from uplift.design.mixing import dispersive, kubelka_munk, pigments

    paints = pigments.from_opaque(cube.reflectance([blue, yellow]), dispersive(cube.data.sensor))
    kubelka_munk.opaque_reflectance(paints.mix([2, 1]))  # two parts of blue, one part of yellow
"""

from __future__ import annotations

from uplift.design.mixing.coats import Coat
from uplift.design.mixing.criteria import Criterion, CriterionResult
from uplift.design.mixing.duntley import Flux
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.mixers import Mixer, mixers
from uplift.design.mixing.overpaint import Overpainter
from uplift.design.mixing.phosphors import Monitor
from uplift.design.mixing.pigments import Pigment
from uplift.design.mixing.recipes import Ingredients, Medium, make_coat, mix, ramp
from uplift.design.mixing.scattering import PowerOfReflectance, Scattering, dispersive
from uplift.design.mixing.surface import Surface

__all__ = [
    "Coat",
    "Criterion",
    "CriterionResult",
    "Flux",
    "Ingredients",
    "Layer",
    "Medium",
    "Mixer",
    "Monitor",
    "Overpainter",
    "Pigment",
    "PowerOfReflectance",
    "Scattering",
    "Surface",
    "dispersive",
    "make_coat",
    "mix",
    "mixers",
    "ramp",
]
