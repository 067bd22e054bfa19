"""Spectra in rows: a row of wavelengths with a row per spectrum below it, or a row per
sample.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from uplift.atlas import truncate
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
    Row,
    Run,
    covers_visible,
    is_value,
    is_visible,
    line_texts,
    parse_cell,
    parse_label,
    runs,
)
from uplift.extras.formats.tables.grid import (
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
    """Whether the row below wavelengths has numbers that are not wavelengths."""
    if header.at + 1 == len(grid.rows):
        return False
    below = grid.rows[header.at + 1][header.run.first : header.run.last]
    numbers = [parse_cell(cell.text) for cell in below]
    values = np.array([number for number in numbers if number is not None])
    return len(values) > 0 and not (len(values) > 1 and is_visible(values))


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
        body.append((*row, *[Cell("", line)] * (len(header) - len(row))))
    others = [*range(run.first), *range(run.last, len(header))]
    column = _name_column(header, body, others)
    prefix = header[run.first].text if run.prefix else ""
    kinds = [
        other
        for other in others
        if plain_label(header[other].text) in TABLE["words"]["kinds"]
    ]
    series = list[Series]()
    for number, row in enumerate(body, 1):
        name = Cell(f"sample {number}", row[0].line) if column is None else row[column]
        label = " ".join([prefix, *(row[kind].text for kind in kinds)]).strip()
        series.append(Series(label, nm.tolist(), row[run.first : run.last], name))
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
        name = _first(header, lambda text: plain_label(text) in NAME_LABELS)
        wavelength = _first(header, names_wavelengths)
        value = _first(header, lambda text: is_plain(text) or text in ("R", "r"))
        if name is not None and wavelength is not None and value is not None:
            return _sample_table(grid, index, (name, wavelength, value))
    return None


def _first(header: Row, is_wanted: Callable[[str], bool]) -> int | None:
    """Return the first column whose label is wanted."""
    return next(
        (column for column, cell in enumerate(header) if is_wanted(cell.text)), None
    )


def _sample_table(
    grid: Grid, index: int, columns: tuple[int, int, int]
) -> Table | None:
    """Return a spectrum for each name in the first of three columns; the header is the
    row of an index.
    """
    header = grid.rows[index]
    remarks = grid.remarks(index)
    wavelengths = defaultdict[str, list[float]](list)
    values = defaultdict[str, list[Cell]](list)
    for row in grid.rows[index + 1 :]:
        name, wavelength, value = [cell_at(row, column) for column in columns]
        label = parse_label(wavelength.text)
        if label is not None:
            wavelengths[name.text].append(label.number)
            values[name.text].append(value)
        elif is_value(value.text):
            problem = f"wavelength '{truncate(wavelength.text)}' is not a number"
            raise grid.location.at(row[0].line, name.text).error(
                problem, "write a plain number such as 400"
            )
        else:
            remarks += line_texts([row])
    are_measured = any(is_value(name) and not name.isdigit() for name in values)
    fewest = min(map(len, values.values()), default=0)
    if are_measured or fewest < 2:  # another layout
        return None
    _, wavelength_column, value_column = columns
    stated = find_unit(header[wavelength_column].text) or grid.unit
    unit = stated or unit_by_values(np.unique(np.concatenate([*wavelengths.values()])))
    label_text = header[value_column].text
    series = [
        Series(
            label_text,
            to_nm(wavelengths[name], unit).tolist(),
            tuple(cells),
            Cell(name, cells[0].line),
        )
        for name, cells in values.items()
    ]
    return Table(series, remarks, ("layout: a row per sample",))
