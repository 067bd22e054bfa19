"""Choice of the few wavelengths that a renderer traces for given materials and lights.

Examples
--------
>>> import numpy as np
>>> reflectances = np.outer([0.2, 0.8], np.linspace(0.5, 1, 391))  # at 380, 381, …, 770 nm
>>> setup = make_setup(reflectances, ["D65", "FL11"])
>>> choice = choose(setup, target=1.0)
>>> choice.sampling.to_xyz.shape == (len(choice.sampling), 3)
True
>>> choice.errors.max <= 1.0
True
"""

from uplift.scene.wavelengths.choose import METHODS, Choice, choose, choose_orders, fit_weights
from uplift.scene.wavelengths.sampling import ColourErrors, Sampling, grid, make_setup

__all__ = [
    "METHODS",
    "Choice",
    "ColourErrors",
    "Sampling",
    "choose",
    "choose_orders",
    "fit_weights",
    "grid",
    "make_setup",
]
