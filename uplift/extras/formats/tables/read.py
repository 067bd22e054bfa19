"""Spectra of a grid of cells.

Wavelengths lie in a row, with a row per spectrum below; in a column, with a column per
spectrum; or in a column before each spectrum. All else is text: preamble, comments,
lines below. It states scale, quantity and unit.
"""

import contextlib
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from uplift.atlas.document import SourceLocation, truncate
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError
from uplift.common.text import pluralise
from uplift.extras.formats.measurements import Measurements, wrong_quantity
from uplift.extras.formats.quantities import (
    REFLECTANCE,
    label_quantity,
    name_quantities,
    remark_quantity,
)
from uplift.extras.formats.samples import Spectrum, is_missing
from uplift.extras.formats.scales import comma_scales
from uplift.extras.formats.statements import (
    NANOMETRE,
    PERCENT,
    Scale,
    label_scale,
    remark_scale,
    to_nm,
)
from uplift.extras.formats.tables.cells import (
    SHORTEST,
    Cell,
    Row,
    is_value,
    line_texts,
    parse_cell,
    runs,
    texts_of,
)
from uplift.extras.formats.tables.columns import (
    Block,
    blocks,
    pairs_of_lines,
    spectra_of,
)
from uplift.extras.formats.tables.grid import (
    LAYOUT,
    MAX_AXIS,
    MAX_PREAMBLE,
    NAME_LABELS,
    Grid,
    Table,
    plain_label,
)
from uplift.extras.formats.tables.rows import find_samples, headers, spectra_below

NO_TABLE = "neither an atlas text (no 'Entry ID') nor a table of reflectances"


def read_grid(grid: Grid, stem: str) -> Measurements:
    """Read the spectra of a grid. One without a name has that of the file, ``stem``."""
    try:
        table = _find_table(grid)
    except AtlasError:
        rows = _without_repeats(grid.rows)
        if len(rows) == len(grid.rows):
            raise
        table = _find_table(replace(grid, rows=rows))
    if not table.series:
        raise _no_table(grid)
    scales = [remark_scale(text) for text in table.remarks]
    labels = [series.label for series in table.series]
    commas = list[Scale]()
    if grid.may_group:
        cells = chain.from_iterable(series.cells for series in table.series)
        stated = filter(None, [*scales, *map(label_scale, labels)])
        divisors = [scale.divisor for scale in stated]
        commas = comma_scales([cell.text for cell in cells], divisors)
    mark = "," if len(commas) == 1 else ""
    nameless = sum(series.name is None for series in table.series)
    spectra = list[Spectrum]()
    for series, by_set in zip(table.series, name_quantities(labels), strict=True):
        name = series.name
        quantity = label_quantity(series.label) or by_set
        if name is None:
            first = series.cells[0]
            name = Cell(stem if nameless == 1 else series.label, first.line)
            quantity = quantity or label_quantity(stem)
            if not name.text:
                location = grid.location.at(first.line)
                if quantity:
                    raise wrong_quantity(quantity, location)
                raise location.error("the header row is missing", LAYOUT)
        values, percent = _values(series.cells, mark, grid.location.at(entry=name.text))
        if quantity is None or quantity.kind is REFLECTANCE:
            scales += [label_scale(series.label), remark_scale(name.text), percent]
        spectra.append(
            Spectrum(name.text, series.nm, values, line=name.line, quantity=quantity)
        )
    return Measurements(
        tuple(spectra),
        skipped=table.skipped,
        scales=tuple(filter(None, [*scales, *commas])),
        notes=table.notes,
        quantity=remark_quantity(table.remarks),
        labelled=not nameless or any(labels),
    )


def _values(
    cells: Row, mark: str, location: SourceLocation
) -> tuple[Sequence[float] | Array, Scale | None]:
    """Parse the values of a spectrum without the ``mark`` of thousands, NaN where one
    is missing, and the scale that percent signs in cells state.
    """
    texts = texts_of(cells)
    joined = "".join(texts)
    if joined.isascii() and "_" not in joined:  # which Python accepts in numbers
        with contextlib.suppress(ValueError):
            return np.array(list(map(float, texts))), None
    values = list[float]()
    percents = [cell.text for cell in cells if cell.text.endswith("%")]
    for cell in cells:
        value = parse_cell(cell.text.replace(mark, ""))
        if value is None:
            problem = f"value '{truncate(cell.text)}' is not a number"
            raise location.at(cell.line).error(
                problem, "write a plain number such as 0.125"
            )
        values.append(value)
    if not percents:
        return values, None
    if len(percents) < (~is_missing(values)).sum():
        problem = (
            f"{len(percents)} of {pluralise(len(cells), 'value')} are in percent, "
            f"such as '{percents[0]}'"
        )
        raise location.at(cells[0].line).error(
            problem, "give all or none in percent", code="mixed-scales"
        )
    return values, Scale(PERCENT, percents[0])


def _find_table(grid: Grid) -> Table:
    return find_samples(grid) or pairs_of_lines(grid) or _rows_or_columns(grid)


def _without_repeats(rows: Sequence[Row]) -> list[Row]:
    """Leave out rows of labels that are repeated, as on a new page."""
    kept = list[Row]()
    labels = set[str]()
    for row in rows:
        text = line_texts([row])[0]
        if _has_number(row) or text not in labels:
            kept.append(row)
            labels.add(text)
    return kept


def _rows_or_columns(grid: Grid) -> Table:
    """Find the row or the column of wavelengths. Raise `AtlasError` if there is none,
    or if both may be meant.
    """
    header = max(headers(grid), key=lambda header: len(header.nm), default=None)
    found = list(blocks(grid))
    block = _longest(found)
    if block is None:
        if header is None:
            raise _no_table(grid)
        return spectra_below(grid, header)
    if header is None or header.at != block.run.first - 1:
        rows = range(block.run.first, block.run.last)
        others = [
            other
            for other in found
            if other.column == block.column and other.run.first not in rows
        ]
        return spectra_of(block, others)
    corner = grid.rows[header.at][block.column]
    if plain_label(corner.text) in NAME_LABELS:
        return spectra_below(grid, header)
    problem = "the first row and the first column may both be wavelengths"
    raise grid.location.at(corner.line).error(
        problem, "label the names 'name', or give them letters"
    )


def _longest(found: Sequence[Block]) -> Block | None:
    """Return the block of most rows, from the first column on that has wavelengths in
    some of them.
    """
    if not found:
        return None
    rows = max(found, key=lambda block: len(block.rows)).run
    block = next(
        each
        for each in found
        if rows.first <= each.run.first and each.run.last <= rows.last
    )
    before = [np.nan] * (block.run.first - rows.first)
    after = [np.nan] * (rows.last - block.run.last)
    numbers = [*before, *block.run.numbers, *after]
    run = block.run._replace(first=rows.first, last=rows.last, numbers=numbers)
    return replace(block, run=run)


def _no_table(grid: Grid) -> AtlasError:
    """Create the error for a grid without spectra."""
    if not grid.rows:
        return grid.location.at(1).error(NO_TABLE, LAYOUT, code="not-an-atlas")
    columns = [grid.column(column) for column in range(MAX_AXIS)]
    for cells in (*grid.rows[:MAX_PREAMBLE], *columns):
        for run in runs(cells):
            nm = to_nm(run.numbers, run.unit or grid.unit or NANOMETRE)
            if len(nm) > 2 and (run.prefix or nm.min() >= SHORTEST):
                return _wrong_range(grid.location.at(cells[run.first].line), nm)
    # A line with numbers was meant to be understood.
    first = next(filter(_has_number, grid.rows), grid.rows[0])
    text = truncate(line_texts([first])[0])
    problem = (
        f"{NO_TABLE}; read as a table, this line has {pluralise(len(first), 'cell')}: "
        f"'{text}'"
    )
    return grid.location.at(first[0].line).error(problem, LAYOUT, code="not-an-atlas")


def _wrong_range(location: SourceLocation, nm: Array) -> AtlasError:
    """Create the error for wavelengths in nm that do not cover the visible range."""
    problem = f"wavelengths must cover 400–700 nm, got {nm.min():g}–{nm.max():g} nm"
    hint = (
        "add the missing wavelengths, or state their unit in a label, such as "
        "'Wavelength (µm)'"
    )
    return location.error(problem, hint)


def _has_number(row: Row) -> bool:
    return any(is_value(cell.text) for cell in row)
