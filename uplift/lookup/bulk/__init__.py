"""Millions of colours: a cube prepared once for textures, then queried through JAX, on CPU or accelerator.

The first call compiles. For a few thousand colours `uplift.Cube` is faster.

Examples
--------
>>> import numpy as np
>>> import uplift
>>> sample = uplift.bulk.spectra(uplift.load(), [450, 550, 650])
>>> image = np.full((2, 4, 3), 0.5)
>>> sample(image).shape
(2, 4, 3)
"""

from __future__ import annotations

from uplift.lookup.bulk.sampler import Sampler, coefficients, max_rgb_error, spectra

__all__ = ["Sampler", "coefficients", "max_rgb_error", "spectra"]
