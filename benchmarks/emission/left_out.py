"""Which lamps a prediction of a lamp must not know, and predictions by tables that are built without them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import uplift
from uplift.colorimetry.lights import Lamps
from uplift.common.arrays import Array
from uplift.lights.discs import LampEntries
from uplift.lights.lookup import EmissionTable
from uplift.lights.prior import relit_delta_e

FAMILIES = {
    "daylight": r"[BC]|I?D\d\d",
    "tungsten": r"A|.*Incandescent",
    "equal energy": r"E",
    "xenon": r"Kinoton.*",
    "halophosphate": r"FL[1-6]|FL3\.[1-3]|(Cool White|Daylight) FL|F34.*",
    "broadband fluorescent": r"FL[7-9]|FL3\.([4-6]|1[2-5])|F40.*|Natural|Thorn.*",
    "three-band fluorescent": r"FL1[0-2]|FL3\.([7-9]|1[01])|F32.*|Philips TL-84|T8 .*|Triphosphor FL",
    "discharge": r"HP\d|.*HPS\)?|LPS|Mercury|H38.*|MHC.*|Metal Halide",
    "phosphor LED": r"LED-(B|BH|V)\d|PHOS-\d|Phosphor LED.*|Luxeon.*",
    "LED mixture": r"LED-RGB1|[34]-LED.*",
}
"""Patterns of the names of colour-science, by the technology of the lamp."""
SAME_COLOURS = 0.5
"""Mean ΔE00 of the relit ColorChecker up to which two lamps are near-duplicates."""


@dataclass(frozen=True, eq=False)
class Predictions:
    """Power (n, N) of lights by tables with the discs of other lamps and without any, and expected errors (n,)."""

    table: Array
    without_discs: Array
    expected: Array


def family(name: str) -> str:
    """Return the family of a lamp.

    Raises
    ------
    LookupError
        The lamp has no family, or several.
    """
    found = [key for key, pattern in FAMILIES.items() if re.fullmatch(pattern, name)]
    if len(found) != 1:
        raise LookupError(f"families of lamp '{name}': {found}")
    return found[0]


def unknown_lamps(lamps: Lamps, reflectances: Array, radiometry: Array) -> dict[str, NDArray[np.bool_]]:
    """Return which lamps (L, L) the prediction of each lamp must not know, by rule.

    Parameters
    ----------
    lamps : Lamps
        L lamps.
    reflectances : ndarray, shape (P, N)
        Surfaces by whose colours lamps are near-duplicates.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    """
    count = len(lamps)
    families = np.array([family(name) for name in lamps.names])
    apart = np.array(
        [
            relit_delta_e(lamps.power, np.tile(row, (count, 1)), reflectances, radiometry).mean(axis=1)
            for row in lamps.power
        ]
    )
    return {
        "lamp": np.eye(count, dtype=bool),
        "near-duplicates": (apart <= SAME_COLOURS) | (apart.T <= SAME_COLOURS),
        "family": families[:, None] == families,
    }


def predict(names: tuple[str, ...], unknown: NDArray[np.bool_], power: Array, **size: int) -> Predictions:
    """Predict lights by tables that are built without the lamps that each must not know.

    Parameters
    ----------
    names : tuple of str
        L lamps, those that tables are built from.
    unknown : ndarray of bool, shape (n, L)
        Lamps that the prediction of each light must not know.
    power : ndarray, shape (n, N)
        Lights, of which only the chromaticity is used, and the luminance.
    **size
        Numbers of knots and rings.
    """
    table, without_discs, expected = np.empty_like(power), np.empty_like(power), np.empty(len(power))
    for left_out, rows in groups(unknown):
        built = uplift.build_emission(without=[names[row] for row in left_out], **size)
        rgb = built.rgb(power[rows])
        table[rows], without_discs[rows] = built.spectrum(rgb), drop_discs(built).spectrum(rgb)
        expected[rows] = built.expected_error(rgb)
    return Predictions(table, without_discs, expected)


def groups(unknown: NDArray[np.bool_]) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield each set of lamps to leave out, and the lamps that it predicts."""
    sets, member = np.unique(unknown, axis=0, return_inverse=True)
    for number, left_out in enumerate(sets):
        yield np.flatnonzero(left_out), np.flatnonzero(member == number)


def drop_discs(table: EmissionTable) -> EmissionTable:
    """Remove the exact lamps from a table."""
    entries = table.data.entries
    none = LampEntries((), entries.uv[:0], entries.spectra[:0], entries.radius[:0])
    return EmissionTable(replace(table.data, entries=none))
