"""Spectra of millions of colours: a cube is prepared once, then queried through JAX, on
CPU or accelerator. `spectra` and `coefficients` are for images in NumPy, `traceable`,
`traceable_coefficients` and `evaluate` for programs in JAX, which compile and
differentiate them.

Examples
--------
>>> import numpy as np
>>> import uplift.bulk
>>> sample = uplift.bulk.spectra(uplift.load(), [450, 550, 650])
>>> image = np.full((2, 4, 3), 0.5)
>>> sample(image).shape
(2, 4, 3)

>>> import jax
>>> traced = uplift.bulk.traceable(uplift.load(), [450, 550, 650])
>>> at_550 = lambda rgb: uplift.bulk.evaluate(traced, rgb)[1]
>>> jax.grad(at_550)(jax.numpy.array([0.5, 0.5, 0.5])).shape
(3,)
"""

from uplift.lookup.bulk import Sampler, coefficients, spectra
from uplift.lookup.traceable import (
    TraceableCube,
    evaluate,
    traceable,
    traceable_coefficients,
)

__all__ = [
    "Sampler",
    "TraceableCube",
    "coefficients",
    "evaluate",
    "spectra",
    "traceable",
    "traceable_coefficients",
]
