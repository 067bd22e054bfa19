"""Tables of colour-science by name: observers, illuminants, lamps, cameras and RGB
spaces.

Importing colour-science takes a second, so what most commands need is in a file that
``tools/ship_tables.py`` makes of it: spectra on 380–780 nm every 5 nm, and RGB spaces.
Everything else comes from colour-science itself. The data are Copyright 2013 Colour
Developers, BSD-3-Clause, as part of colour-science.
"""

import functools
import operator
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry import illuminants as lights
from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.common.arrays import Array, as_nm
from uplift.common.colour_science import colour_science
from uplift.common.errors import OptionError, UnknownNameError, unknown_name

PATH = Path(__file__).parent / "tables.npz"
START, END, STEP = WAVELENGTHS = (380.0, 780.0, 5.0)
"""Range and step in nm of the spectra of the file."""
SPECTRA = {
    "illuminant": "SDS_ILLUMINANTS",
    "observer": "colorimetry.MSDS_CMFS_STANDARD_OBSERVER",
}
"""Tables of colour-science whose spectra the file has, by the kind of their names."""
TABLES = {
    **SPECTRA,
    "light source": "SDS_LIGHT_SOURCES",
    "camera": "MSDS_CAMERA_SENSITIVITIES",
    "display": "MSDS_DISPLAY_PRIMARIES",
    "RGB space": "RGB_COLOURSPACES",
}
"""All tables of colour-science that are used."""
FILES = {
    "illuminant": (
        "here an illuminant is a name; in Python pass the lamp that uplift.read_lamp "
        "reads"
    ),
    "observer": (
        "sensitivities of a camera need space='camera' and a file .csv, .tsv, .txt "
        "or .json"
    ),
    "camera": "files of cameras end in .csv, .tsv, .txt or .json",
}
"""Hints for files in place of a name."""
RESPONSES = ("observer", "camera")
"""Kinds that are 0 outside their tables: a wavelength without a value adds nothing.
Others keep their last value.
"""
SHORT_NAMES = {
    "ap0": "ACES2065-1", "ap1": "ACEScg", "p3": "Display P3",
    "prophoto": "ProPhoto RGB",
    "rec709": "ITU-R BT.709", "bt709": "ITU-R BT.709", "rec2020": "ITU-R BT.2020",
    "bt2020": "ITU-R BT.2020",
}  # fmt: skip
"""RGB spaces by short names, in lower case and without punctuation."""


@dataclass(frozen=True, eq=False)
class RgbSpace:
    """An RGB space of colour-science."""

    name: str
    primaries: Array
    """(3, 2) chromaticities."""
    whitepoint: Array
    """(2,) chromaticity."""
    matrix_XYZ_to_RGB: Array  # noqa: N815 — the name of colour-science
    """(3, 3)."""
    decoding: Array
    """(256,) linear values of the 8-bit codes."""

    def cctf_decoding(self, values: Any) -> Any:
        """Decode values from 0 to 1 by the transfer function of colour-science."""
        return colour_science().RGB_COLOURSPACES[self.name].cctf_decoding(values)


@functools.cache
def _file() -> Mapping[str, Array]:
    with np.load(PATH) as arrays:
        return dict(arrays)


@functools.cache
def names(kind: str) -> tuple[str, ...]:
    """Return the names of a kind: ``"illuminant"``, ``"observer"``, ``"camera"``,
    ``"RGB space"``…

    >>> names("camera")
    ('Nikon 5100 (NPL)', 'Sigma SDMerill (NPL)')
    """
    return tuple(_file()[f"{kind}: names"].tolist())


@functools.cache
def stated_name(kind: str, name: Illuminant) -> str:
    """Return the name that colour-science states for a name, which may be an alias or
    have other capitals.

    A lamp has its own, which must not be that of an illuminant.
    """
    if isinstance(name, Lamp):
        if name.name in names(kind):
            raise OptionError(
                f"a lamp must not have the name of an illuminant, got '{name}'",
                hint="rename the lamp",
            )
        return name.name
    name, _ = lights.standard_name(name) if kind == "illuminant" else (name, None)
    if name in names(kind):
        return str(_file()[f"{kind}: stated"][names(kind).index(name)])
    return str(look_up(kind, name).name)


@functools.cache
def samples(
    kind: str,
    name: Illuminant,
    start: float = START,
    end: float = END,
    step: float = STEP,
) -> Array:
    """Sample spectra by name, or those of a lamp; the result is read-only. Shape (N,)
    or (N, 3).

    Outside its table a spectrum keeps its last value, as CIE 15 has it for lights, and
    one of `RESPONSES` is 0. ``kind`` is one of the keys of `TABLES`, such as
    ``"display"`` for the power of the primaries of a display.
    """
    as_nm([start, end])
    if isinstance(name, Lamp):
        values = name.at(np.arange(start, end + step / 2, step))
        values.setflags(write=False)
        return values
    name, kelvin = lights.standard_name(name) if kind == "illuminant" else (name, None)
    if kelvin is not None and kelvin < lights.DAYLIGHT_FROM:
        values = lights.black_body(kelvin, np.arange(start, end + step / 2, step))
    elif kind in SPECTRA and (start, end, step) == WAVELENGTHS and name in names(kind):
        values = _file()[f"{kind}: samples"][names(kind).index(name)]
    else:
        values = np.array(
            aligned(kind, look_up(kind, name), start, end, step).values, dtype=float
        )
    values.setflags(write=False)
    return values


def aligned(kind: str, spectra: Any, start: float, end: float, step: float) -> Any:
    """Return a copy of spectra of colour-science on a range, see `samples`."""
    shape = colour_science().SpectralShape(start, end, step)
    outside = 0 if kind in RESPONSES else None
    extrapolation = {"method": "Constant", "left": outside, "right": outside}
    return spectra.copy().align(shape, extrapolator_kwargs=extrapolation)


def rgb_space(name: str) -> RgbSpace | None:
    """Return an RGB space by a name of colour-science or one of `SHORT_NAMES`, None if
    it has none of the name.
    """
    known = names("RGB space")
    name = SHORT_NAMES.get(re.sub(r"[ ._-]", "", name.casefold()), name)
    if name not in known:
        table = colour_science().RGB_COLOURSPACES
        if name not in table:
            return None
        name = table[name].name
    row = known.index(name)
    parts = (
        _file()[f"RGB space: {array}"][row]
        for array in ("primaries", "whitepoint", "matrix", "decoding")
    )
    return RgbSpace(stated_name("RGB space", name), *parts)


def bradford(source: Array, target: Array) -> Array:
    """Compute the matrix (3, 3) of Bradford's adaptation from one white XYZ (3,) to
    another.
    """
    matrix = _file()["bradford"]
    # M⁻¹ diag(M w′ / M w) M
    return (
        np.linalg.inv(matrix) @ np.diag((matrix @ target) / (matrix @ source)) @ matrix
    )


def look_up(kind: str, name: str) -> Any:
    """Return an object of colour-science by its name, for an illuminant also by the
    names of `lights`.
    """
    table = operator.attrgetter(TABLES[kind])(colour_science())
    known = list(table)
    if kind == "observer" and name not in table and name in colour_science().MSDS_CMFS:
        hint = "that of CIE 2015 has the cone fundamentals of Stockman & Sharpe as XYZ"
        raise OptionError(
            f"observer must have colour-matching functions of XYZ, got '{name}'",
            hint=hint,
        )
    if kind == "illuminant":
        temperature = f"{name}K" if name.isdecimal() else "3200K"
        known = [*known, *lights.COMMON_NAMES, temperature]
        name, kelvin = lights.standard_name(name)
        if kelvin is not None:
            return _of_temperature(kelvin, name)
    try:
        return table[name]
    except KeyError:
        if kind in FILES and os.path.isfile(name):
            raise UnknownNameError(
                f"unknown {kind} '{name}', which is a file", hint=FILES[kind]
            ) from None
        error = unknown_name(name, known, kind, f"tables.names('{kind}')")
        if kind in FILES and os.path.splitext(name)[1][1:2].isalpha():
            error.problem += ", and no file has this name"
        raise error from None


def _of_temperature(kelvin: float, name: str) -> Any:
    """Return a black body or CIE daylight as an object of colour-science."""
    colour = colour_science()
    if kelvin < lights.DAYLIGHT_FROM:
        wavelengths = np.arange(300.0, 1001.0)
        return colour.SpectralDistribution(
            lights.black_body(kelvin, wavelengths), wavelengths, name=name
        )
    kelvin = min(kelvin * lights.NOMINAL, lights.TEMPERATURES[1])
    daylight = colour.sd_CIE_illuminant_D_series(
        colour.temperature.CCT_to_xy_CIE_D(kelvin)
    )
    daylight.name = name
    return daylight
