"""Choice of the few wavelengths that a renderer traces for given materials and lights:
fitted ones, and those of Gaussian quadrature.

Meyer 1988, "Wavelength selection for synthetic image generation", Computer Vision,
Graphics, and Image Processing 41(1).

Examples
--------
>>> import numpy as np
>>> ramp = np.linspace(0.5, 1, 391)  # at 380, 381, …, 770 nm
>>> reflectances = np.outer([0.2, 0.8], ramp)
>>> setup = make_setup(reflectances, ["D65", "FL11"])
>>> choice = choose(setup, target=1.0)
>>> choice.sampling.to_xyz.shape == (len(choice.sampling), 3)
True
>>> bool(choice.errors.max() <= 1.0)
True
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
