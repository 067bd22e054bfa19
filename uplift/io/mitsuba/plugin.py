"""What Mitsuba's scene descriptions say, made into spectra and textures."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.io.mitsuba.image import Image, decoded, texture
from uplift.lookup import Cube, load

FIRST, LAST = 360, 830
"""nm, of Mitsuba's wavelengths."""
SOURCES = ("rgb", "filename", "bitmap")


def register() -> None:
    """Make ``uplift`` known to Mitsuba's current variant; after each `mitsuba.set_variant`.

    Raises `OptionError` where Mitsuba is not installed, no variant is set, or one that knows no spectra.
    """
    try:
        import mitsuba
    except ImportError as error:
        raise OptionError("Mitsuba 3 is not installed", hint="'pip install mitsuba' brings it") from error
    variant = mitsuba.variant()
    if variant is None or "spectral" not in variant or "polarized" in variant:
        raise OptionError(
            f"Mitsuba's variant {variant} has no plain spectra",
            hint="set scalar_spectral or llvm_ad_spectral",
        )
    mitsuba.register_texture("uplift", _plugin)


def _plugin(props: Any) -> Any:
    """The texture of a scene description. Mitsuba shows the message of what this raises, and refuses other keys."""
    cube = _cube(props)
    given = [name for name in SOURCES if name in props]
    if len(given) != 1:
        raise OptionError(f"an uplift texture takes one of {', '.join(SOURCES)}, not {len(given)}")
    if given == ["rgb"]:
        return _constant(cube, _numbers(props["rgb"]))
    rgb = decoded(cube, _bitmap(props))
    return texture()(props, Image.of(cube, rgb))


def _cube(props: Any) -> Cube:
    if "cube" not in props:
        return load()
    path = _resolved(props["cube"])
    return _loaded(path, path.stat().st_mtime_ns if path.exists() else 0)


@lru_cache(maxsize=4)
def _loaded(path: Path, changed: int) -> Cube:
    """The cube, read once for all textures of a scene, and again when it has ``changed``."""
    return load(path)


def _resolved(name: str) -> Path:
    import mitsuba

    return Path(str(mitsuba.file_resolver().resolve(name)))


def _numbers(given: Any) -> Array:
    """(3,) of '0.8, 0.2, 0.1' or of anything that numpy takes. Raises `OptionError`."""
    try:
        words = given.replace(",", " ").split() if isinstance(given, str) else given
        rgb = np.array([float(word) for word in words])
    except (TypeError, ValueError) as error:
        raise OptionError(f"rgb is three numbers, not {given!r}") from error
    if rgb.shape != (3,):
        raise OptionError(f"rgb is three numbers, not {given!r}")
    return rgb


def _constant(cube: Cube, rgb: Array) -> Any:
    import mitsuba

    values = cube.reflectance(rgb, np.arange(FIRST, LAST + 1))
    text = ", ".join(f"{value:.9g}" for value in values)
    return mitsuba.load_dict(
        {"type": "regular", "wavelength_min": FIRST, "wavelength_max": LAST, "values": text}
    )


def _bitmap(props: Any) -> Any:
    import mitsuba

    return props["bitmap"] if "bitmap" in props else mitsuba.Bitmap(str(_resolved(props["filename"])))
