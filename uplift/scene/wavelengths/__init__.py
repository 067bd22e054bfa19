"""Choice of the few wavelengths that a renderer traces for given materials and lights.

from uplift.scene import wavelengths

seen = wavelengths.set_up(reflectances, ["D65", "FL11"])
choice = wavelengths.choose(seen, target=1.0)
choice.sampling.wavelengths, choice.sampling.to_xyz, choice.sampling.powers, choice.errors.max
"""

from __future__ import annotations

from uplift.scene.wavelengths.choose import MAX_COUNT, METHODS, Choice, choose, fit_weights
from uplift.scene.wavelengths.sampling import MEASURES, ColourErrors, Sampling, evaluate
from uplift.scene.wavelengths.setup import RenderSetup, grid, make_setup

__all__ = [
    "MAX_COUNT",
    "MEASURES",
    "METHODS",
    "Choice",
    "ColourErrors",
    "RenderSetup",
    "Sampling",
    "choose",
    "evaluate",
    "fit_weights",
    "grid",
    "make_setup",
]
