"""Colour space that an image file states; docs/textures.md lists the statements in
their order.

OpenColorIO reads matrix profiles, as displays have them, with their primaries and tone
curves. Profiles of grey images, and those with lookup tables, are not used.
"""

import contextlib
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.files import atomic_write
from uplift.extras.colour.spaces import ImageSpace, find_ocio_space
from uplift.extras.colour.srgb import decode
from uplift.extras.images import code_points

NOT_STATED = ("", "unknown")
"""Values of colorInteropID that name no space."""
ROUNDING = 1e-6
"""Largest step back of a curve by single precision."""
SRGB_SPACE = ImageSpace("sRGB", SRGB, decode)
"""Space of 8-bit and 16-bit images that state none."""
ADOBE = ImageSpace(
    "Adobe RGB (1998)",
    Primaries((0.64, 0.33), (0.21, 0.71), (0.15, 0.06), SRGB.white),
    code_points.power(563 / 256),
)
EXIF_SRGB = 1
"""Value of the EXIF tag ColorSpace for sRGB."""
EXIF_ADOBE = 2
"""The value that cameras write for Adobe RGB; the standard does not have it."""
ADOBE_INDEX = "R03"
"""EXIF interoperability index of Adobe RGB (DCF 2.0)."""
CMYK = "CMYK"
CODE_BITS = {"uint8": 8, "uint16": 16}


@dataclass(frozen=True, eq=False)
class Profile:
    """Statement of an image file about its colour space; ``space`` is None if it cannot
    be used.

    ``unusable`` are the names of it or of preceding statements that cannot be used.
    """

    name: str
    space: ImageSpace | None
    unusable: tuple[str, ...] = ()


def read_profile(spec: Any, header: Mapping[str, Any]) -> Profile | None:
    """Return the first usable statement of a file, else an unusable one, or None if it
    states no colour space.

    ``spec`` is an `OpenImageIO.ImageSpec`, and ``header`` has the statements that it
    lacks.
    """
    unusable = list[str]()
    if CMYK in (
        spec.get_string_attribute("tiff:ColorSpace"),
        spec.get_string_attribute("jpeg:ColorSpace"),
    ):
        # OpenImageIO converts it to RGB without a profile
        return Profile(CMYK, None, (CMYK,))
    for statement in _statements(spec, header):
        if statement.space is not None:
            return replace(statement, unusable=tuple(unusable))
        unusable.append(statement.name)
    return Profile(unusable[0], None, tuple(unusable)) if unusable else None


def _statements(spec: Any, header: Mapping[str, Any]) -> Iterator[Profile]:
    """Yield the statements of a file in the order of precedence."""
    interop = str(spec.get_string_attribute("colorInteropID"))
    if interop not in NOT_STATED:
        yield Profile(interop, _interop_space(interop))
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        yield _by_primaries("chromaticities", chromaticities)
    if (points := header.get("cICP", spec.getattribute("CICP"))) is not None:
        yield _by_code_points(points, CODE_BITS.get(str(spec.format), 8))
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = (
            spec.get_string_attribute("ICCProfile:profile_description")
            or "an ICC profile without a name"
        )
        is_bytes = isinstance(data, np.ndarray) and data.dtype == np.uint8
        yield Profile(name, _icc_space(name, data.tobytes()) if is_bytes else None)
    elif "iCCP" in header:
        yield Profile("a damaged ICC profile", None)
    if "sRGB" in header:
        yield Profile("sRGB", SRGB_SPACE)
    yield from _png_gamma(header)
    yield from _exif_adobe(header)
    yield from _tiff_tags(header)
    yield from _exif_other(header)
    if "PRIMARIES" in header:
        yield _by_primaries("PRIMARIES", header["PRIMARIES"])


def xyz_space(spec: Any) -> ImageSpace:
    """Return the space of channels of CIE XYZ, relative to the white that an OpenEXR
    file states, else to D65.
    """
    primaries = _primaries(spec.getattribute("chromaticities")) or SRGB
    luminance = spec.get_float_attribute("whiteLuminance", 1.0)
    name = "CIE XYZ"
    if primaries.white != SRGB.white:
        name += " of white {:g},{:g}".format(*primaries.white)
    if not 0 < luminance < np.inf:
        luminance = 1.0
    elif luminance != 1:
        name += f" of whiteLuminance {luminance:g}"
    to_rgb = np.linalg.inv(primaries.rgb_to_xyz) / luminance
    return ImageSpace(name, primaries, lambda values: values, to_gamut=to_rgb)


def _interop_space(name: str) -> ImageSpace | None:
    """Return the space of a name of the Color Interop Forum, which the configuration of
    OpenColorIO has as alias.
    """
    space = None
    with contextlib.suppress(OptionError):
        space = find_ocio_space(name)
    return None if space is None else space.as_image_space()


def _by_primaries(name: str, numbers: Any) -> Profile:
    primaries = _primaries(numbers)
    return Profile(name, None if primaries is None else ImageSpace(name, primaries))


def _by_code_points(points: Any, bits: int) -> Profile:
    values = points if isinstance(points, tuple) else ()
    name = "CICP " + ", ".join(map(str, values[:2]))
    if values[2:] not in ((0, 1), ()):
        name += f" with matrix {values[2]}" if values[2] else " of narrow range"
    return Profile(name, code_points.find_space(name, values, bits))


def _png_gamma(header: Mapping[str, Any]) -> Iterator[Profile]:
    """Yield the space of the chunks gAMA and cHRM of PNG. One alone has the other of
    sRGB.
    """
    gamut: Primaries | None = SRGB
    curve: code_points.Curve | None = decode
    names = []
    if "gAMA" in header:
        gamma = header["gAMA"]
        names.append(f"gAMA {gamma:g}")
        curve = code_points.power(1 / gamma) if gamma > 0 else None
    if "cHRM" in header:
        names.append("cHRM")
        gamut = _primaries(header["cHRM"])
    if names:
        yield _by_parts(" and ".join(names), gamut, curve)


def _tiff_tags(header: Mapping[str, Any]) -> Iterator[Profile]:
    """Yield the space of the tags TransferFunction, WhitePoint and
    PrimaryChromaticities of TIFF.
    """
    gamut: Primaries | None = SRGB
    curve: code_points.Curve | None = decode
    names = [
        name
        for name in ("TransferFunction", "PrimaryChromaticities", "WhitePoint")
        if name in header
    ]
    if "TransferFunction" in header:
        curve = _table_curve(np.atleast_1d(header["TransferFunction"]))
    if names and names != ["TransferFunction"]:
        # One without the other is not a gamut.
        gamut = _primaries(
            (*header.get("PrimaryChromaticities", ()), *header.get("WhitePoint", ()))
        )
    if names:
        yield _by_parts(" and ".join(names), gamut, curve)


def _by_parts(
    name: str, gamut: Primaries | None, curve: code_points.Curve | None
) -> Profile:
    if gamut is None or curve is None:
        return Profile(name, None)
    return Profile(name, ImageSpace(name, gamut, curve))


def _table_curve(numbers: Array) -> code_points.Curve | None:
    """Return the curve of one or three tables of 16-bit numbers; None for others."""
    tables = numbers / 65535
    is_triple = len(tables) in (3 << 8, 3 << 16)
    tables = tables.reshape(3, -1) if is_triple else np.tile(tables, (3, 1))
    count = tables.shape[1]
    if count not in (1 << 8, 1 << 16) or not (np.diff(tables) >= 0).all():
        return None
    at = np.linspace(0, 1, count)
    return lambda codes: np.stack(
        [np.interp(codes[..., k], at, tables[k]) for k in range(3)], axis=-1
    )


def _exif_adobe(header: Mapping[str, Any]) -> Iterator[Profile]:
    """Yield Adobe RGB if the EXIF tag ColorSpace or the interoperability index states
    it.
    """
    number = header.get("ColorSpace")
    is_index = (
        number != EXIF_SRGB and header.get("InteroperabilityIndex") == ADOBE_INDEX
    )
    if number == EXIF_ADOBE or is_index:
        yield Profile(ADOBE.name, ADOBE)


def _exif_other(header: Mapping[str, Any]) -> Iterator[Profile]:
    """Yield sRGB if the EXIF tag ColorSpace states it, and an unusable statement for
    other numbers.
    """
    number = header.get("ColorSpace")
    if number == EXIF_SRGB:
        yield Profile("sRGB", SRGB_SPACE)
    elif number is not None:
        yield Profile(f"EXIF ColorSpace {number}", None)


def _primaries(numbers: Any) -> Primaries | None:
    """Return primaries; None for impossible ones, and for values of another type, as an
    attribute may have any.
    """
    try:
        return Primaries.of([float(number) for number in numbers])
    except (OptionError, TypeError, ValueError):
        return None


def _icc_space(name: str, data: bytes) -> ImageSpace | None:
    """Return the space of a matrix profile by OpenColorIO; None for others, and for
    damaged ones.
    """
    import PyOpenColorIO as ocio  # noqa: N813

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "image.icc"
        with atomic_write(path) as temporary:
            temporary.write_bytes(data)
        transform = ocio.FileTransform(str(path), direction=ocio.TRANSFORM_DIR_INVERSE)
        try:
            to_xyz = code_points.ocio_space(name, transform)
        except ocio.Exception:
            return None
    corners = to_xyz.convert(np.vstack([np.eye(3), np.ones(3)]))
    gamut = _primaries((corners / corners.sum(axis=1, keepdims=True))[:, :2].ravel())
    if gamut is None:
        return None
    to_linear = np.linalg.inv(to_xyz.matrix).T
    values = to_xyz.convert(np.linspace([0.0] * 3, [1.0] * 3, 256)) @ to_linear
    if not (np.isfinite(values).all() and (np.diff(values, axis=0) >= -ROUNDING).all()):
        return None
    return ImageSpace(name, gamut, lambda codes: to_xyz.convert(codes) @ to_linear)
