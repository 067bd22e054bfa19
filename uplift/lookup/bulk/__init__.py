"""Millions of colours: a cube made ready once for textures, then asked through JAX, on CPU or accelerator.

    from uplift.lookup import bulk

    sample = bulk.spectra(cube, range(400, 701, 20))
    sample(image)  # (h, w, 3) -> (h, w, 16) float32

For a few thousand colours `uplift.Cube` answers sooner: here something is compiled first.
"""

from __future__ import annotations

from uplift.lookup.bulk.sampler import Sampler, coefficients, max_rgb_error, spectra

__all__ = ["Sampler", "coefficients", "max_rgb_error", "spectra"]
