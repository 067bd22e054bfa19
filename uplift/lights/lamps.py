"""Lamps: spectral powers from the formats of atlas files."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from uplift.atlas.atlas import Atlas, merge
from uplift.atlas.document import Document, SourceLocation, read_document
from uplift.atlas.formats import recognise
from uplift.atlas.measurements import Measurements, accept_power, to_atlas
from uplift.common.arrays import StrPath


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
    with accept_power():
        found = chosen.read(document)
    if isinstance(found, Atlas):
        raise SourceLocation(document.path).error(
            f"a file of the format {chosen.name} holds reflectances, not the power of lamps",
            "give spectral powers, such as a CSV table",
            code="not-a-lamp",
        )
    return to_atlas(document, _scaled(document, found), chosen.name, "fraction")


def _scaled(document: Document, measurements: Measurements) -> Measurements:
    """Divide each lamp by its largest power."""
    spectra = []
    for spectrum in measurements.spectra:
        values = np.asarray(spectrum.values, dtype=float)
        highest = float(values[np.isfinite(values)].max(initial=0))
        if highest <= 0:
            raise SourceLocation(document.path, spectrum.line, spectrum.name).error(
                "a lamp must have power, got none above 0", "remove the lamp", code="lamp-without-power"
            )
        spectra.append(replace(spectrum, values=values / highest))
    return replace(measurements, spectra=tuple(spectra), scale=None)
