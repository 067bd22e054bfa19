"""Lamps: spectral powers of colour-science, and from the formats of atlas files."""

import warnings
from dataclasses import replace

import numpy as np

from uplift.atlas.atlas import Atlas, merge, skipped_warning
from uplift.atlas.document import Document, truncate
from uplift.atlas.formats import read_any
from uplift.atlas.measurements import Measurements, to_atlas
from uplift.atlas.sources import find_atlas_file, read_named
from uplift.colorimetry import tables
from uplift.colorimetry.observer import DEFAULT_OBSERVER, END, START, STEP, matching_functions
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import AtlasError
from uplift.lights.discs import Lamps

VISIBLE = (400.0, 700.0)
"""Range in nm that a lamp must cover."""
SAME_LAMP = 1e-3
"""Difference, as a fraction of the largest power, below which two lamps are one."""


def known_lamps(observer: str = DEFAULT_OBSERVER, start: float = START, end: float = END, step: float = STEP) -> Lamps:
    """Return the lights of colour-science: CIE illuminants and measured lamps.

    Lights that are measured on less than 400–700 nm, and lights with the spectrum of an earlier one, are left out.
    """
    luminance = matching_functions(observer, start, end, step)[:, 1]
    found: dict[str, Array] = {}
    for kind in ("illuminant", "light source"):
        for name in tables.names(kind):
            nm = tables.look_up(kind, name).wavelengths
            if nm[0] > VISIBLE[0] or nm[-1] < VISIBLE[1]:
                continue
            power = np.maximum(tables.samples(kind, name, start, end, step), 0.0)
            power = power * (luminance.sum() / (power @ luminance))
            if all(np.abs(power - other).max() > SAME_LAMP * other.max() for other in found.values()):
                found[name] = power
    return Lamps(tuple(found), np.array(list(found.values())))


def read_lamps(*paths: StrPath) -> Atlas:
    """Read files of spectral powers into one atlas, in the formats of `uplift.atlas.read_atlas`.

    Powers have no common scale: the largest one of each lamp is 1. `AtlasError` for files of reflectances and lamps
    without power.
    """
    atlas = merge(map(_read, map(read_named, map(find_atlas_file, paths))))
    if atlas.skipped:
        warnings.warn(skipped_warning(atlas.skipped, code="lamp-skipped"), stacklevel=2)
    return atlas


def _read(document: Document) -> Atlas:
    chosen, found = read_any(document)
    if isinstance(found, Atlas):
        raise _not_a_lamp("reflectance spectrum", document)
    stated = [spectrum.quantity or found.quantity for spectrum in found.spectra]
    of_material = [quantity for quantity in stated if quantity is not None and not quantity.of_light]
    if of_material and len(of_material) == len(stated):
        raise _not_a_lamp(of_material[0].text, document)
    return to_atlas(document, _scaled(document, found), chosen.name, "fraction")


def _not_a_lamp(stated: str, document: Document) -> AtlasError:
    problem = f"the file states '{truncate(stated)}', not the power of a lamp"
    return document.location.error(problem, "give spectral powers, such as a CSV table", code="not-a-lamp")


def _scaled(document: Document, measurements: Measurements) -> Measurements:
    """Divide each lamp by its largest power."""
    spectra = []
    for spectrum in measurements.spectra:
        quantity = spectrum.quantity or measurements.quantity
        if quantity is not None and not quantity.of_light:
            continue
        values = np.asarray(spectrum.values, dtype=float)
        highest = float(values[np.isfinite(values)].max(initial=0))
        if highest <= 0:
            raise document.location.at(spectrum.line, spectrum.name).error(
                "a lamp must have power, got none above 0", "remove the lamp"
            )
        spectra.append(replace(spectrum, values=values / highest, quantity=None))
    return replace(measurements, spectra=tuple(spectra), quantity=None)
