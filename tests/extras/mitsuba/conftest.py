"""Fixtures: Mitsuba in its scalar spectral variant, with the texture plugin. Tests are
skipped without it.
"""

import pytest

from tests.parts import MITSUBA, need

STORED = "moments-8-macbeth.uplift"


@pytest.fixture(scope="session")
def mi():
    """Mitsuba with the texture plugin ``uplift``."""
    need(MITSUBA)
    import mitsuba

    from uplift.extras.mitsuba.plugin import register

    mitsuba.set_variant("scalar_spectral")
    register()
    return mitsuba


@pytest.fixture(scope="session")
def cube_path(repository):
    """Path of the cube of ``small_cube``."""
    return str(repository / "cubes" / STORED)


@pytest.fixture
def spectrum(mi):
    """Function that evaluates reflectance (N,) of a texture at (u, v) and wavelengths
    (N,) in nm.
    """
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
