"""Lamps: spectral powers from the formats of atlas files."""

import warnings
from dataclasses import replace

import numpy as np

from uplift.atlas.atlas import Atlas, merge
from uplift.atlas.document import Document, read_document, truncate
from uplift.atlas.formats import recognise
from uplift.atlas.measurements import Measurements, to_atlas
from uplift.common.arrays import StrPath

REFLECTANCES = "reflectance"
"""Quantity of a measurement archive."""


def read_lamps(*paths: StrPath) -> Atlas:
    """Read files of spectral powers into one atlas, in the formats of `uplift.atlas.read_atlas`.

    Powers have no common scale: the largest one of each lamp is 1. `AtlasError` for files of reflectances and lamps
    without power.
    """
    atlas = merge(map(_read, map(read_document, paths)))
    for skipped in atlas.skipped:
        warnings.warn(skipped.warning(), stacklevel=2)
    return atlas


def _read(document: Document) -> Atlas:
    chosen = recognise(document)
    found = chosen.read(document)
    stated = REFLECTANCES if isinstance(found, Atlas) else found.material
    if isinstance(found, Atlas) or stated:
        problem = f"the file states '{truncate(stated)}', not the power of a lamp"
        raise document.location.error(problem, "give spectral powers, such as a CSV table")
    return to_atlas(document, _scaled(document, found), chosen.name, "fraction")


def _scaled(document: Document, measurements: Measurements) -> Measurements:
    """Divide each lamp by its largest power."""
    spectra = []
    for spectrum in measurements.spectra:
        values = np.asarray(spectrum.values, dtype=float)
        highest = float(values[np.isfinite(values)].max(initial=0))
        if highest <= 0:
            raise document.location.at(spectrum.line, spectrum.name).error(
                "a lamp must have power, got none above 0", "remove the lamp"
            )
        spectra.append(replace(spectrum, values=values / highest))
    return replace(measurements, spectra=tuple(spectra), scale=None)
