"""Spectra in pairs of wavelength and value that stand side by side on a line."""

from collections.abc import Sequence
from itertools import chain

import numpy as np

from uplift.common.arrays import Array
from uplift.extras.formats.statements import NANOMETRE, to_nm
from uplift.extras.formats.tables.cells import (
    SHORTEST,
    Row,
    are_wavelengths,
    is_value,
    line_texts,
    parse_cell,
    texts_of,
)
from uplift.extras.formats.tables.grid import Grid, Series, Table

EQUAL = 1e-6
"""Tolerance in nm of equal steps."""


def pairs_of_lines(grid: Grid) -> Table | None:
    """Read a table with a spectrum on each line, perhaps behind its name."""
    series = list[Series]()
    remarks = list[str]()
    for row in grid.rows:
        if not any(is_value(cell.text) for cell in row):
            remarks += line_texts([row])
            continue
        name = None if is_value(row[0].text) else row[0]
        cells = row if name is None else row[1:]
        nm = _wavelengths(cells, grid.unit or NANOMETRE)
        if nm is None or not (np.isfinite(nm).all() and are_wavelengths(nm)):
            return None
        series.append(Series(str(len(series) + 1), nm, cells[1::2], name))
    return Table(series, remarks, ("layout: pairs, a line per spectrum",))


def pairs_of_rows(rows: Sequence[Row], unit: float) -> Series | None:
    """Return the spectrum whose wavelengths go on from pair to pair in equal steps, and
    then to the next line.
    """
    cells = tuple(chain.from_iterable(rows))
    nm = _wavelengths(cells, unit)
    if nm is None or max(map(len, rows)) < 4:
        return None
    have_equal_steps = np.ptp(np.diff(nm)) <= EQUAL  # not with NaN
    return Series("", nm, cells[1::2], None) if have_equal_steps else None


def _wavelengths(cells: Row, unit: float) -> Array | None:
    """Return the first numbers of pairs in nm; None for cells that are not pairs."""
    numbers = np.array(list(map(parse_cell, texts_of(cells))), float)
    first = numbers[::2]
    second = numbers[1::2]
    if len(first) != len(second) or not (second < SHORTEST).any():
        return None
    return to_nm(first, unit)
