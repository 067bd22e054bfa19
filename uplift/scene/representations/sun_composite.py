"""Sun's composite model (CS): spikes, and Fourier coefficients of the smooth part.

Sun, Drew & Fracchia 1999, "Representing spectral functions by a composite model of smooth and spiky components for
efficient full-spectrum photorealism"; Kment 2011, section 5.4.
"""

from __future__ import annotations

from uplift.scene.representations.composite import Composite
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.fourier_coefficients import fourier_coefficients

THRESHOLD = 0.3
"""Relative gradient of spikes, from Kment 2011, section 6.1."""


def sun_composite(count: int) -> Composite:
    """Make the representation with ``count`` real Fourier coefficients."""
    smooth = fourier_coefficients(count)
    return Composite(f"CS{count}", "Sun's composite", smooth, smooth.waves[:, ::TABLE_STRIDE], THRESHOLD)
