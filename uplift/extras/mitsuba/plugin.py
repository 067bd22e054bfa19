"""Conversion of Mitsuba scene descriptions to spectra and textures."""

from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import METHODS, map_to_gamut
from uplift.common.arrays import Array, Values
from uplift.common.errors import (
    ColourError,
    CubeFileError,
    OptionError,
    UpliftError,
    UpliftWarning,
    needs_package,
    warn,
)
from uplift.extras.colour.srgb import decode
from uplift.extras.emission.lookup import EmissionTable, load_emission
from uplift.extras.images.counts import Counts
from uplift.extras.images.exr_file import is_exr
from uplift.extras.mitsuba import texels
from uplift.extras.texture.emission import light_reader
from uplift.lookup.cube import Cube, load
from uplift.models.model import evaluate

START = 360
"""First wavelength of Mitsuba in nm."""
END = 830
"""Last wavelength of Mitsuba in nm."""
IMAGES = ("filename", "bitmap")
SOURCES = ("rgb", *IMAGES)
HINTS = {
    (
        CubeFileError,
        "file-not-found",
    ): "set the property cube to a cube, or add its folder to Mitsuba's file resolver",
    (
        ColourError,
        "rgb-out-of-gamut",
    ): f"set the property out_of_gamut to {', '.join(METHODS[1:])}",
}
"""Hints in terms of Mitsuba's properties, by class and code; the library's own name
parameters of Python.
"""


def register() -> None:
    """Register the plugins ``uplift`` and ``uplift_envmap`` in Mitsuba's current
    variant.

    Call it after each `mitsuba.set_variant`.

    Raises
    ------
    OptionError
        Mitsuba is not installed (code ``extra-not-installed``), or the variant is not
        set, not spectral, or polarised.
    """
    with needs_package("plugins", OptionError):
        import mitsuba
    variant = mitsuba.variant()
    if variant is None or "spectral" not in variant or "polarized" in variant:
        raise OptionError(
            f"Mitsuba's variant must be spectral and unpolarised, got {variant}",
            hint="set scalar_spectral or llvm_ad_spectral",
        )
    mitsuba.register_texture("uplift", partial(_make_plugin, _make))
    mitsuba.register_emitter("uplift_envmap", partial(_make_plugin, _make_environment))


def _make_plugin(make: Callable[[Any], Any], props: Any) -> Any:
    """Make the object of a scene description. Mitsuba shows the message of exceptions,
    and rejects unknown keys.
    """
    try:
        return make(props)
    except UpliftError as error:
        if (key := (type(error), error.code)) not in HINTS:
            raise
        raise RuntimeError(error.describe(HINTS[key])) from error


def _make(props: Any) -> Any:
    from uplift.extras.mitsuba.texture import make_texture

    is_light = props.get("emission", False)
    if _source(props, SOURCES) == "rgb":
        rgb = _parse_rgb(props["rgb"])
        wavelengths = np.arange(START, END + 1, dtype=float)
        if is_light:
            return _constant(_table(props).spectrum(rgb, wavelengths))
        return _constant(_reflectance(props, rgb, wavelengths))
    spectra = _texels(props, is_light=is_light)
    placement = texels.Placement.read(props)
    _warn_in_scalar_variants("texture")
    return make_texture(props, spectra, placement)


def _reflectance(props: Any, rgb: Array, wavelengths: Array) -> Array:
    """Return the reflectance (n,) of linear RGB (3,), that of an entry outside [0, 1]
    too.
    """
    cube = _cube(props)
    method = str(props.get("out_of_gamut", "error"))
    if cube.data.outside_boxes.find(rgb[None]).rows.size:
        uplifter = texels.prepare_texels(cube, method, of_entries=True)
        _, multipliers, _ = uplifter.numbers(rgb[None].astype(np.float32))
        model = cube.data.atlas.spectra.model
        return evaluate(model, multipliers.astype(float), wavelengths)[0]
    mapped = map_to_gamut(rgb, cube.data.sensor, method)
    return cube.reflectance(mapped.rgb, wavelengths)


def _make_environment(props: Any) -> Any:
    from uplift.extras.mitsuba.texture import make_environment

    _source(props, IMAGES)
    _warn_in_scalar_variants("environment")
    return make_environment(props, _texels(props, is_light=True))


def _warn_in_scalar_variants(name: str) -> None:
    import mitsuba

    if mitsuba.variant().startswith("scalar"):
        problem = f"the {name} calls Python for every ray in scalar variants"
        warn(
            UpliftWarning(
                problem, code="texture-in-python", hint="set llvm_ad_spectral"
            )
        )


def _source(props: Any, names: tuple[str, ...]) -> str:
    sources = [name for name in names if name in props]
    if len(sources) != 1:
        problem = (
            f"an uplift texture must have one of {', '.join(names)}, got {len(sources)}"
        )
        raise OptionError(problem, hint="pass one of them")
    return sources[0]


def _texels(props: Any, *, is_light: bool) -> texels.Texels:
    """Read the spectra of a spectral texture, or uplift an image; colours outside [0,
    1] are mapped, with a warning.
    """
    import mitsuba

    path = _resolve(props["filename"]) if "filename" in props else None
    if path is not None and (spectra := texels.read_texels(path)) is not None:
        return spectra
    rgb: Values
    read_warnings: tuple[UpliftWarning, ...] = ()
    counts = Counts()
    if is_light:
        table = _table(props)
        if path is None:
            rgb = _linear(decode, props["bitmap"])
        else:
            rgb, counts, read_warnings = texels.read_colours(path, light_reader(table))
        spectra = texels.light_texels(table, rgb.astype(float))
    else:
        cube = _cube(props)
        method = str(props.get("out_of_gamut", "clip"))
        uplifter = texels.prepare_texels(cube, method)
        if path is not None and path.is_file() and is_exr(path):
            rgb, counts, read_warnings = texels.read_colours(path, uplifter.reader)
        else:
            bitmap = props["bitmap"] if path is None else mitsuba.Bitmap(str(path))
            rgb, counts = uplifter.reader.mapped(
                _linear(lambda codes: cube.decode(255 * codes), bitmap)
            )
        spectra, converted = texels.uplift_texels(uplifter, rgb)
        counts += converted
    for warning in (*read_warnings, *counts.warnings(path)):
        warn(warning)
    return spectra


def _table(props: Any) -> EmissionTable:
    return load_emission(_resolve(props["cube"]) if "cube" in props else None)


def _cube(props: Any) -> Cube:
    if "cube" not in props:
        return load()
    path = _resolve(props["cube"])
    return _load(path, path.stat().st_mtime_ns if path.exists() else 0)


@lru_cache(maxsize=4)
def _load(path: Path, modified: int) -> Cube:
    """Read the cube once for all textures of a scene, and again when the file was
    modified.
    """
    return load(path)


def _resolve(name: str) -> Path:
    import mitsuba

    return Path(str(mitsuba.file_resolver().resolve(name)))


def _parse_rgb(value: Any) -> Array:
    """Return linear RGB (3,) of '0.8, 0.2, 0.1' or a sequence."""
    try:
        words = value.replace(",", " ").split() if isinstance(value, str) else value
        red, green, blue = (float(word) for word in words)
    except (TypeError, ValueError) as error:
        raise OptionError(
            f"rgb must be three numbers, got {value!r}",
            hint="for example '0.8, 0.2, 0.1'",
        ) from error
    return np.array([red, green, blue])


def _constant(values: Array) -> Any:
    import mitsuba

    text = ", ".join(f"{value:.9g}" for value in values)
    return mitsuba.load_dict(
        {
            "type": "regular",
            "wavelength_min": START,
            "wavelength_max": END,
            "values": text,
        }
    )


def _linear(decoding: Callable[[Array], Array], bitmap: Any) -> Array:
    """Return linear RGB (h, w, 3) of a `mitsuba.Bitmap`. Codes in [0, 1]
    are decoded.
    """
    import mitsuba

    rgb = bitmap.convert(pixel_format=mitsuba.Bitmap.PixelFormat.RGB)
    values = np.array(rgb)
    if values.dtype.kind == "u":
        values = values / np.iinfo(values.dtype).max
    return decoding(values) if bitmap.srgb_gamma() else values.astype(float)
