"""Conversion of Mitsuba scene descriptions to spectra and textures."""

from __future__ import annotations

import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import METHODS, check_method, map_to_gamut
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftError, UpliftWarning
from uplift.io.mitsuba.native import find_plugin, native_properties
from uplift.io.mitsuba.texels import Placement, Texels, uplift_texels
from uplift.io.mitsuba.texture import make_texture
from uplift.io.mitsuba.texture_file import read_colours, read_texels
from uplift.io.texture.colours import Decoder
from uplift.io.texture.exr_file import is_exr
from uplift.lookup import Cube, load

START, END = 360, 830
"""Wavelength range of Mitsuba in nm."""
NATIVE_VARIANT = "scalar_spectral"
SOURCES = ("rgb", "filename", "bitmap")
HINTS = {
    "cube-not-found": "set the property cube to the file of a cube, or add its folder to Mitsuba's file resolver",
    "rgb-out-of-gamut": f"set the property out_of_gamut to {', '.join(METHODS[1:])}",
    "unknown-gamut-mapping": f"set the property out_of_gamut to {', '.join(METHODS)}",
}
"""Hints in terms of Mitsuba's properties, by code; the library's own name parameters of Python."""


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
    mitsuba.register_texture("uplift", _make_plugin)


def _make_plugin(props: Any) -> Any:
    """Make the object of a scene description. Mitsuba shows the message of exceptions, and rejects unknown keys."""
    try:
        return _make(props)
    except UpliftError as error:
        if error.code not in HINTS:
            raise
        raise RuntimeError(error.describe(HINTS[error.code])) from error


def _make(props: Any) -> Any:
    sources = [name for name in SOURCES if name in props]
    if len(sources) != 1:
        raise OptionError(
            f"an uplift texture must have one of {', '.join(SOURCES)}, got {len(sources)}",
            code="texture-source",
            hint="pass one of them",
        )
    if sources == ["rgb"]:
        cube, method = _cube(props), str(props.get("out_of_gamut", "error"))
        return _constant(cube, map_to_gamut(_parse_rgb(props["rgb"]), cube.data.sensor, method).rgb)
    texels = read_texels(_resolve(props["filename"])) if "filename" in props else None
    return _texture(props, _uplifted(props) if texels is None else texels)


def _texture(props: Any, texels: Texels) -> Any:
    """Return the texture in C++ in scalar variants, if it was compiled, else the texture in Python."""
    import mitsuba

    placement = Placement.read(props)
    if mitsuba.variant() != NATIVE_VARIANT:
        return make_texture(props, texels, placement)
    folder = find_plugin()
    if folder is None:
        warnings.warn(
            UpliftWarning(
                "the texture calls Python for every ray in scalar variants",
                code="texture-in-python",
                hint="run 'python -m uplift.io.mitsuba' once to compile it, or set llvm_ad_spectral",
            ),
            stacklevel=2,
        )
        return make_texture(props, texels, placement)
    if str(folder) not in map(str, mitsuba.file_resolver()):
        mitsuba.file_resolver().append(str(folder))
    return mitsuba.load_dict(native_properties(texels, placement))


def _uplifted(props: Any) -> Texels:
    """Uplift an image of colours. Those outside [0, 1] are mapped, with a warning."""
    cube, method = _cube(props), str(props.get("out_of_gamut", "clip"))
    check_method(method)
    path = _resolve(props["filename"]) if "filename" in props else None
    if path is not None and path.is_file() and is_exr(path):
        rgb, found = read_colours(path, cube.data.sensor, method)
    else:
        rgb, counts = Decoder(np.asarray, False, False, None, cube.data.sensor, method)(
            _linear(cube, _bitmap(props, path))
        )
        found = counts.warnings(method, path)
    for warning in found:
        warnings.warn(warning, stacklevel=2)
    return uplift_texels(cube, rgb.astype(float))


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


def _bitmap(props: Any, path: Path | None) -> Any:
    import mitsuba

    return props["bitmap"] if path is None else mitsuba.Bitmap(str(path))


def _linear(cube: Cube, bitmap: Any) -> Array:
    """Return linear RGB (h, w, 3) of a `mitsuba.Bitmap`. Encoded images are decoded in the cube's space."""
    import mitsuba

    rgb = bitmap.convert(pixel_format=mitsuba.Bitmap.PixelFormat.RGB)
    values = np.array(rgb)
    if values.dtype.kind == "u":
        values = values / np.iinfo(values.dtype).max
    return cube.decode(255 * values) if bitmap.srgb_gamma() else values.astype(float)
