"""Conversion of Mitsuba scene descriptions to spectra and textures."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.io.mitsuba.image import Image, decode_bitmap, texture_class
from uplift.lookup import Cube, load

START, END = 360, 830
"""Wavelength range of Mitsuba in nm."""
SOURCES = ("rgb", "filename", "bitmap")


def register() -> None:
    """Register the plugin ``uplift`` in Mitsuba's current variant. Call it after each `mitsuba.set_variant`.

    Raises
    ------
    OptionError
        Mitsuba is not installed (code ``mitsuba-not-installed``), or the variant is not set, not spectral, or polarised
        (``unsupported-variant``).
    """
    try:
        import mitsuba
    except ImportError as error:
        raise OptionError(
            "Mitsuba 3 is not installed",
            code="mitsuba-not-installed",
            hint="install it: pip install 'spectral-uplift[mitsuba]'",
        ) from error
    variant = mitsuba.variant()
    if variant is None or "spectral" not in variant or "polarized" in variant:
        raise OptionError(
            f"Mitsuba's variant must be spectral and unpolarised, got {variant}",
            code="unsupported-variant",
            hint="set scalar_spectral or llvm_ad_spectral",
        )
    mitsuba.register_texture("uplift", _make_texture)


def _make_texture(props: Any) -> Any:
    """Make the texture of a scene description. Mitsuba shows the message of exceptions, and rejects unknown keys."""
    cube = _cube(props)
    sources = [name for name in SOURCES if name in props]
    if len(sources) != 1:
        raise OptionError(
            f"an uplift texture must have one of {', '.join(SOURCES)}, got {len(sources)}",
            code="texture-source",
            hint="pass one of them",
        )
    if sources == ["rgb"]:
        return _constant(cube, _parse_rgb(props["rgb"]))
    rgb = decode_bitmap(cube, _bitmap(props))
    return texture_class()(props, Image.uplift(cube, rgb))


def _cube(props: Any) -> Cube:
    if "cube" not in props:
        return load()
    path = _resolve(props["cube"])
    return _load(path, path.stat().st_mtime_ns if path.exists() else 0)


@lru_cache(maxsize=4)
def _load(path: Path, modified: int) -> Cube:
    """Read the cube once for all textures of a scene, and again when the file was modified."""
    return load(path)


def _resolve(name: str) -> Path:
    import mitsuba

    return Path(str(mitsuba.file_resolver().resolve(name)))


def _parse_rgb(value: Any) -> Array:
    """Return linear RGB (3,) of '0.8, 0.2, 0.1' or a sequence. Raises `OptionError` (``invalid-rgb``)."""
    try:
        words = value.replace(",", " ").split() if isinstance(value, str) else value
        red, green, blue = (float(word) for word in words)
    except (TypeError, ValueError) as error:
        raise OptionError(
            f"rgb must be three numbers, got {value!r}",
            code="invalid-rgb",
            hint="for example '0.8, 0.2, 0.1'",
        ) from error
    return np.array([red, green, blue])


def _constant(cube: Cube, rgb: Array) -> Any:
    import mitsuba

    values = cube.reflectance(rgb, np.arange(START, END + 1))
    text = ", ".join(f"{value:.9g}" for value in values)
    return mitsuba.load_dict(
        {"type": "regular", "wavelength_min": START, "wavelength_max": END, "values": text}
    )


def _bitmap(props: Any) -> Any:
    import mitsuba

    return props["bitmap"] if "bitmap" in props else mitsuba.Bitmap(str(_resolve(props["filename"])))
