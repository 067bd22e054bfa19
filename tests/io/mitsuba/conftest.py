"""Mitsuba in its scalar spectral variant, which needs nothing else installed; skipped where it is absent."""

from __future__ import annotations

import pytest

STORED = "moments-8-macbeth.uplift"


@pytest.fixture(scope="session")
def mi():
    """Mitsuba, with the texture ``uplift``."""
    mitsuba = pytest.importorskip("mitsuba")
    from uplift.io.mitsuba import register

    mitsuba.set_variant("scalar_spectral")
    register()
    return mitsuba


@pytest.fixture(scope="session")
def stored(repository):
    """Path of the cube that ``small_cube`` is."""
    return str(repository / "cubes" / STORED)


@pytest.fixture
def spectrum(mi):
    """Reflectance (N,) of a texture at (u, v) and wavelengths (N,) nm."""
    import drjit

    def spectrum(texture, uv, wavelengths):
        si = drjit.zeros(mi.SurfaceInteraction3f)
        si.uv = mi.Point2f(*uv)
        found = []
        for wavelength in wavelengths:
            si.wavelengths = mi.Spectrum(float(wavelength))
            found.append(texture.eval(si)[0])
        return found

    return spectrum
