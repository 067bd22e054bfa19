"""Spectra of millions of colours: a cube is prepared once, then queried through JAX, on
CPU or accelerator.

Examples
--------
>>> import numpy as np
>>> import uplift.bulk
>>> sample = uplift.bulk.spectra(uplift.load(), [450, 550, 650])
>>> image = np.full((2, 4, 3), 0.5)
>>> sample(image).shape
(2, 4, 3)
"""

from uplift.lookup.bulk import Sampler, coefficients, spectra

__all__ = ["Sampler", "coefficients", "spectra"]
