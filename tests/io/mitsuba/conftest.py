"""Fixtures: Mitsuba in its scalar spectral variant, with textures in Python and C++. Tests are skipped without it."""

from __future__ import annotations

import pytest

from tests.parts import CXX, MITSUBA, need
from uplift.io.mitsuba import compile_plugin, plugin

STORED = "moments-8-macbeth.uplift"


@pytest.fixture(scope="session")
def mi():
    """Mitsuba with the texture plugin ``uplift``."""
    need(MITSUBA)
    import mitsuba

    from uplift.io.mitsuba import register

    mitsuba.set_variant("scalar_spectral")
    register()
    return mitsuba


@pytest.fixture(scope="session")
def compiled(mi, tmp_path_factory):
    """Folder of the texture in C++, compiled into a temporary folder. Skipped without a compiler."""
    need(CXX)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        return compile_plugin()


@pytest.fixture
def in_python(mi, monkeypatch):
    """Evaluate images in Python, whether or not a texture in C++ was compiled."""
    monkeypatch.setattr(plugin, "find_plugin", lambda: None)


@pytest.fixture(params=["python", "native"])
def language(request, mi, monkeypatch):
    """Evaluate images in Python and in C++."""
    folder = None if request.param == "python" else request.getfixturevalue("compiled")
    monkeypatch.setattr(plugin, "find_plugin", lambda: folder)
    return request.param


@pytest.fixture(scope="session")
def cube_path(repository):
    """Path of the cube of ``small_cube``."""
    return str(repository / "cubes" / STORED)


@pytest.fixture
def spectrum(mi):
    """Function that evaluates reflectance (N,) of a texture at (u, v) and wavelengths (N,) in nm."""
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
