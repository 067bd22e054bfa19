"""Spectra in rows: a row of wavelengths with a row per spectrum below it, or a row per
sample.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from uplift.atlas.document import truncate
from uplift.common.arrays import Array
from uplift.common.text import pluralise
from uplift.extras.formats.measurements import not_used_note
from uplift.extras.formats.quantities import TABLE, is_photometric
from uplift.extras.formats.statements import (
    METRE,
    NANOMETRE,
    find_unit,
    is_plain,
    names_wavelengths,
    to_nm,
    unit_by_values,
)
from uplift.extras.formats.tables.cells import (
    Cell,
    Line,
    Row,
    Run,
    covers_visible,
    is_value,
    is_visible,
    line_texts,
    parse_cell,
    parse_label,
    runs,
    texts_of,
)
from uplift.extras.formats.tables.grid import (
    MAX_HEADS,
    MAX_PREAMBLE,
    NAME_LABELS,
    Grid,
    Series,
    Table,
    cell_at,
    plain_label,
)


class Header(NamedTuple):
    """A row of wavelengths: its index, the cells of the wavelengths, and their numbers
    in nm.
    """

    at: int
    run: Run
    nm: Array


def headers(grid: Grid) -> Iterator[Header]:
    """Yield the indices of rows with wavelengths in nm, and numbers in the
    row below.
    """
    for index, row in enumerate(grid.rows[:MAX_PREAMBLE]):
        for run in runs(row):
            by_values = METRE if max(run.numbers) < 1e-5 else NANOMETRE
            nm = to_nm(run.numbers, run.unit or grid.unit or by_values)
            header = Header(index, run, nm)
            if _is_meant(grid, header) and _has_values_below(grid, header):
                yield header


def _is_meant(grid: Grid, header: Header) -> bool:
    """Whether numbers are meant as wavelengths: by their range, by the label of the
    names to their left, or by the prefix of their labels.
    """
    run = header.run
    corner = grid.rows[header.at][0].text
    if run.first == 1 and plain_label(corner) in NAME_LABELS:
        return covers_visible(header.nm) or (bool(run.prefix) and len(header.nm) > 2)
    return is_visible(header.nm) or (bool(run.prefix) and len(header.nm) > 2)


def _has_values_below(grid: Grid, header: Header) -> bool:
    """Whether the row below wavelengths, or below their units, has numbers that are not
    wavelengths.
    """
    for row in grid.rows[header.at + 1 : header.at + 1 + MAX_HEADS]:
        below = row[header.run.first : header.run.last]
        numbers = [parse_cell(cell.text) for cell in below]
        values = np.array([number for number in numbers if number is not None])
        if len(values):
            return len(values) == 1 or not is_visible(values)
    return False


def spectra_below(grid: Grid, wavelengths: Header) -> Table:
    """Return a spectrum for each row below a row of wavelengths that has a value at one
    of them.
    """
    index, run, nm = wavelengths
    header = grid.rows[index]
    remarks = grid.remarks(index)
    body = list[Row]()
    for row in grid.rows[index + 1 :]:
        line = row[0].line
        if texts_of(row) == texts_of(header):  # repeated on a new page
            continue
        if not any(is_value(cell.text) for cell in row[run.first : run.last]):
            remarks += line_texts([row])
            continue
        if len(row) > len(header):
            problem = (
                f"a row must have {pluralise(len(header), 'cell')} like the header "
                f"row, got {len(row)}"
            )
            hint = (
                "put a name that contains the separator in quotes, or remove the "
                "other cells"
            )
            raise grid.location.at(line).error(problem, hint)
        missing = len(header) - len(row)
        body.append(Line([*texts_of(row), *[""] * missing], line) if missing else row)
    others = [*range(run.first), *range(run.last, len(header))]
    column = _name_column(header, body, others)
    prefix = header[run.first].text
    kinds = [
        other
        for other in others
        if plain_label(header[other].text) in TABLE["words"]["kinds"]
    ]
    series = list[Series]()
    for number, row in enumerate(body, 1):
        name = Cell(f"sample {number}", row[0].line) if column is None else row[column]
        label = " ".join([prefix, *(row[kind].text for kind in kinds)]).strip()
        series.append(Series(label, nm, row[run.first : run.last], name))
    unused = [header[other].text for other in others if other != column]
    remarks += filter(is_photometric, unused)
    if column is not None:
        remarks.append(header[column].text)
    return Table(
        series, remarks, ("layout: a row per spectrum", *not_used_note(unused))
    )


def _name_column(header: Row, body: Sequence[Row], others: Sequence[int]) -> int | None:
    """Return the column of the names: that of a usual label whose texts differ, or else
    the first one.
    """
    # Labels that state a name come before those of numbers, unless they repeat a name.
    ranks = {label: rank for rank, label in enumerate(NAME_LABELS)}
    labels = {index: plain_label(header[index].text) for index in others}
    named = [index for index in others if labels[index] in ranks]
    known = sorted(named, key=lambda index: ranks[labels[index]])
    for index in known:
        names = [row[index].text for row in body]
        if all(names) and len(set(names)) == len(names):
            return index
    return next(iter((*known, *others)), None)


def find_samples(grid: Grid) -> Table | None:
    """Read a table with a row per sample: a name, a wavelength and a reflectance, in
    any order of columns.
    """
    for index, header in enumerate(grid.rows[:MAX_PREAMBLE]):
        if is_value(header[-1].text):
            continue
        wavelength = _first(header, names_wavelengths)
        value = _first(header, _names_values)
        if wavelength is not None and value is not None:
            table = _sample_table(grid, index, wavelength, value)
            if table is not None:
                return table
    return None


def _first(header: Row, is_wanted: Callable[[str], bool]) -> int | None:
    """Return the first column whose label is wanted."""
    return next(
        (column for column, cell in enumerate(header) if is_wanted(cell.text)), None
    )


def _names_values(text: str) -> bool:
    """Whether a label is that of reflectances, and not that of a sample."""
    return (is_plain(text) or text in ("R", "r")) and not names_wavelengths(text)


def _sample_table(grid: Grid, index: int, wavelength: int, value: int) -> Table | None:
    """Return a spectrum for each name in a table with a row per sample below the row of
    an index; None for another layout.
    """
    header = grid.rows[index]
    remarks = grid.remarks(index)
    rows = list[Row]()
    numbers = list[float]()
    for row in grid.rows[index + 1 :]:
        label = parse_label(cell_at(row, wavelength).text)
        if label is None and not is_value(cell_at(row, value).text):
            remarks += line_texts([row])
            continue
        rows.append(row)
        numbers.append(np.nan if label is None else label.number)
    others = [at for at in range(len(header)) if at not in (wavelength, value)]
    groups = _samples_by_name(header, rows, numbers, others)
    if groups is None:
        return None
    unit = find_unit(header[wavelength].text) or grid.unit
    if unit is None:
        unit = unit_by_values(np.unique(numbers))
    series = list[Series]()
    for name, members in groups.items():
        for at in members:
            if np.isnan(numbers[at]):
                text = truncate(cell_at(rows[at], wavelength).text)
                raise grid.location.at(rows[at][0].line, name).error(
                    f"wavelength '{text}' is not a number",
                    "write a plain number such as 400",
                )
        nm = to_nm([numbers[at] for at in members], unit).tolist()
        cells = tuple(cell_at(rows[at], value) for at in members)
        series.append(Series(header[value].text, nm, cells, Cell(name, cells[0].line)))
    return Table(series, remarks, ("layout: a row per sample",))


def _samples_by_name(
    header: Row, rows: Sequence[Row], numbers: Sequence[float], others: Sequence[int]
) -> dict[str, list[int]] | None:
    """Return the rows of each name: a column with a usual label, or else another one
    whose names have each wavelength once; None if no column has the names.
    """
    usual = [at for at in others if plain_label(header[at].text) in NAME_LABELS]
    are_repeated = len(set(numbers)) < len(numbers)
    for column in (*usual, *others) if are_repeated else usual:
        groups = defaultdict[str, list[int]](list)
        name = ""
        for at, row in enumerate(rows):
            name = cell_at(row, column).text or name  # merged cells of spreadsheets
            groups[name].append(at)
        are_measured = any(is_value(name) and {".", ","} & {*name} for name in groups)
        are_spectra = all(_are_distinct(numbers, group) for group in groups.values())
        if are_spectra and not are_measured:
            return groups
    return None


def _are_distinct(numbers: Sequence[float], rows: Sequence[int]) -> bool:
    """Whether rows, two or more, have different numbers."""
    return 1 < len(rows) == len({numbers[row] for row in rows})
