"""Lamps: spectral powers of colour-science, and from the formats of atlas files."""

import os
from dataclasses import replace

import numpy as np

from uplift.atlas.atlas import VISIBLE, Atlas, Entry, merge, skipped_warning
from uplift.atlas.document import Document, SourceLocation
from uplift.atlas.formats import read_any
from uplift.atlas.sources import find_atlas_file, read_named
from uplift.colorimetry import tables
from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.colorimetry.observer import (
    DEFAULT_OBSERVER,
    END,
    START,
    STEP,
    matching_functions,
)
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import (
    AtlasError,
    UpliftError,
    UpliftWarning,
    unknown_name,
    warn,
)
from uplift.common.text import listed, printable
from uplift.extras.colour.spectra_json import POWER, is_json, read_spectra
from uplift.extras.emission.discs import Lamps
from uplift.extras.formats.measurements import Measurements, wrong_quantity
from uplift.extras.formats.quantities import (
    PHOTONS,
    REFLECTANCE,
    Quantity,
)
from uplift.extras.formats.samples import Spectrum, is_missing

SAME_LAMP = 1e-3
"""Difference, as a fraction of the largest power, below which two lamps are one."""


def known_lamps(observer: str = DEFAULT_OBSERVER) -> Lamps:
    """Return the lights of colour-science: CIE illuminants and measured lamps.

    Lights that are measured on less than 400–700 nm, and lights with the spectrum of an
    earlier one, are left out.
    """
    grid = (START, END, STEP)
    luminance = matching_functions(observer, *grid)[:, 1]
    lamps = dict[str, Array]()
    for kind in ("illuminant", "light source"):
        for name in tables.names(kind):
            nm = tables.look_up(kind, name).wavelengths
            if nm[0] > VISIBLE[0] or nm[-1] < VISIBLE[1]:
                continue
            power = np.maximum(tables.samples(kind, name, *grid), 0.0)
            power = power * (luminance.sum() / (power @ luminance))
            if all(
                np.abs(power - other).max() > SAME_LAMP * other.max()
                for other in lamps.values()
            ):
                lamps[name] = power
    return Lamps(tuple(lamps), np.array(list(lamps.values())))


def read_lamps(*paths: StrPath) -> Atlas:
    """Read files of spectral powers into one atlas, in the formats of
    `uplift.atlas.read_atlas`.

    Powers have no common scale: the largest one of each lamp is 1. `AtlasError` for
    files of other quantities and lamps without power.
    """
    atlas = merge(map(_read, map(read_named, map(find_atlas_file, paths))))
    if atlas.skipped:
        warn(skipped_warning(atlas.skipped, code="lamp-skipped"))
    return atlas


def read_lamp(path: StrPath, name: str | None = None) -> Lamp:
    """Read a measured lamp, for functions that take the name of an illuminant.

    Parameters
    ----------
    path : path-like
        File of spectral powers, in a format of `uplift.read_atlas`: such as CSV or SPD
        with lines of a wavelength in nm and a power, CGATS, IES TM-27 (.spdx) or a
        spreadsheet, or JSON of rawtoaces. The powers have any one unit. Photons, such
        as µmol/m²/s/nm, are divided by the wavelength.
    name : str, optional
        Name of a lamp in a file of several.

    Returns
    -------
    Lamp
        The lamp, with the name of the file without its suffix, or its own name if the
        file has several. Names that are those of illuminants are not shortened.
        Negative powers, which are noise, are 0.

    Raises
    ------
    AtlasError
        The file cannot be read, states reflectances, or has several lamps and no
        ``name`` is given.
    UnknownNameError
        No lamp of the file has the name.

    Warns
    -----
    UpliftWarning
        No unit is stated (``lamp-unit``), or spectra of other quantities were left out
        (``lamp-skipped``).

    Examples
    --------
    >>> import uplift
    >>> lamp = uplift.read_lamp("lamp.csv")  # doctest: +SKIP
    >>> cube.standard_error([0.8, 0.2, 0.1], lamp)  # doctest: +SKIP
    """
    lamps = _read_json(path) if is_json(path) else read_lamps(path)
    location = SourceLocation(os.fspath(path))
    file = printable(os.path.basename(path))
    if name is not None and name not in lamps.names:
        raise unknown_name(name, lamps.names, f"lamp of {file}")
    if name is None and len(lamps) != 1:
        names = listed([f"'{lamp}'" for lamp in lamps.names])
        problem = f"a light is one lamp, got a file of {len(lamps)}: {names}"
        raise location.error(
            problem,
            f"name one of them, as in '{file}:{lamps.names[0]}'" if len(lamps) else "",
        )
    entry = lamps[0] if name is None else lamps[name]
    short = os.path.splitext(file)[0] if len(lamps) == 1 else entry.name
    long = file if len(lamps) == 1 else f"{file}:{entry.name}"
    return Lamp(
        long if is_illuminant(short) else short,
        tuple(entry.wavelengths.tolist()),
        tuple(np.maximum(entry.values, 0.0).tolist()),
    )


def find_light(text: str) -> Illuminant:
    """Return the name of an illuminant, or read the lamp of a file: ``lamp.csv``, or
    ``lamps.csv:NAME`` of several.

    A name takes precedence over a file. Raises the errors of `read_lamp`, and
    `UnknownNameError` for a text that is neither.
    """
    file = lamp_file(text)
    if is_illuminant(text) or not os.path.lexists(file):
        tables.stated_name("illuminant", text)
        return text
    return read_lamp(file, text[len(file) + 1 :] if file != text else None)


def lamp_file(text: str) -> str:
    """Return the file of ``lamp.csv``, or of ``lamps.csv:NAME``, if there is one."""
    file = text.rpartition(":")[0]
    return file if not os.path.lexists(text) and os.path.isfile(file) else text


def _read_json(path: StrPath) -> Atlas:
    """Read the lamp of a file of rawtoaces."""
    spectra = read_spectra(path, POWER, AtlasError)
    powers = spectra.values[:, 0]
    stem = os.path.splitext(os.path.basename(path))[0]
    if not powers.max(initial=0) > 0:
        raise SourceLocation(os.fspath(path)).error(
            "a lamp must have power, got none above 0", "name another file"
        )
    return Atlas(
        (Entry(stem, spectra.wavelengths, powers / powers.max(), path=os.fspath(path)),)
    )


def is_illuminant(name: str) -> bool:
    """Whether an illuminant has the name."""
    try:
        tables.stated_name("illuminant", name)
    except UpliftError:
        return False
    return True


def _read(document: Document) -> Atlas:
    chosen, content = read_any(document)
    if not isinstance(content, Measurements):
        stated = Quantity(REFLECTANCE, "reflectance spectrum")
        raise wrong_quantity(stated, document.location, lamps=True)
    content = content.select(document, lamps=True)
    powers = tuple(_power(spectrum, document) for spectrum in content.spectra)
    lamps = replace(content, spectra=powers)
    atlas = lamps.to_atlas(document, chosen.name, "fraction", lamps=True)
    is_spd = document.path.lower().endswith(".spd")
    if not is_spd and not all(map(_has_unit, content.spectra)):
        problem = "no unit of power is stated: values are read as power, not as photons"
        hint = "state it in a label, such as 'W/m²/nm' or 'µmol/m²/s/nm'"
        warn(UpliftWarning(problem, code="lamp-unit", path=document.path, hint=hint))
    return atlas


def _has_unit(spectrum: Spectrum) -> bool:
    quantity = spectrum.quantity
    return quantity is not None and "warning" not in quantity.kind.lamp


def _power(spectrum: Spectrum, document: Document) -> Spectrum:
    """Return the power of a lamp, divided by its largest one. Photons have an energy of
    h c / λ.
    """
    values = np.array(spectrum.values, dtype=float)
    values[is_missing(values)] = np.nan
    if spectrum.quantity and spectrum.quantity.kind is PHOTONS:
        values /= np.asarray(spectrum.wavelengths)
    highest = float(np.nan_to_num(values).max(initial=0))
    if highest <= 0:
        raise document.location.at(spectrum.line, spectrum.name).error(
            "a lamp must have power, got none above 0", "remove the lamp"
        )
    return replace(spectrum, values=values / highest)
