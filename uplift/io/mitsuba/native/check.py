"""Compare the compiled texture with numpy: ``python -m uplift.io.mitsuba.native.check FOLDER``."""

from __future__ import annotations

import sys

import numpy as np

from uplift.io.mitsuba.native.properties import native_properties
from uplift.io.mitsuba.texels import Placement, Texels
from uplift.models import Moments, evaluate

WAVELENGTHS = (400.0, 500.0, 600.0, 700.0)
TOLERANCE = 1e-4


def main(folder: str) -> None:
    """Exit with an error unless a texel has its spectrum."""
    import drjit
    import mitsuba

    mitsuba.set_variant("scalar_spectral")
    mitsuba.file_resolver().prepend(folder)
    model, numbers = Moments(9), np.random.default_rng(4).normal(size=(3, 4, 9)).astype(np.float32)
    placement = Placement("nearest", "repeat", np.eye(3))
    texture = mitsuba.load_dict(native_properties(Texels(model, numbers, 0.5), placement))
    si = drjit.zeros(mitsuba.SurfaceInteraction3f)
    si.uv, si.wavelengths = mitsuba.Point2f(0.6, 0.9), mitsuba.Spectrum(*WAVELENGTHS)
    found, expected = (
        np.array(texture.eval(si)),
        evaluate(model, numbers[2, 2:3].astype(float), WAVELENGTHS)[0],
    )
    if not np.abs(found - expected).max() < TOLERANCE:
        sys.exit("error: the plugin disagrees with numpy")


if __name__ == "__main__":
    main(sys.argv[1])
