"""Tables of known spectra in all combinations of how programs write them: units,
scales, orders, separators, marks.

A reader gives the same spectra, or refuses the table; it never gives other values.
"""

import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError, UpliftWarning

NM = np.arange(350.0, 901.0, 10.0)
"""Wavelengths of all spectra."""
ROUNDING = 2e-5
"""Largest difference by the digits of a table."""
UNITS = {
    "nm": (1.0, "Wavelength (nm)"), "plain": (1.0, "Wavelength"),
    "um": (1e-3, "Wavelength_um"),
    "angstrom": (10.0, "Wavelength [Å]"), "metre": (1e-9, "wavelength [m]"),
    "wave number": (None, "Wavenumber (cm-1)"),
    "plain um": (1e-3, "Wavelength"),
}  # fmt: skip
"""Factor from nm, None for 1/cm, and the label of a column."""
VALUES = {"light": (0.1, 0.9), "dark": (0.002, 0.015), "bright": (0.7, 0.95)}
"""Ranges of reflectances."""
MARKS = ("", "NaN", "-9999", "-1.23e34", "n/a", "--")


@dataclass(frozen=True)
class Writing:
    """How a table is written."""

    layout: str = "columns"
    unit: str = "nm"
    values: str = "light"
    scale: str = "fraction"
    order: str = "ascending"
    separator: str = ","
    decimal: str = "."
    mark: str = "none"
    preamble: str = "none"
    head: str = "names"
    ending: str = "plain"


CHOICES = {
    "layout": ("columns", "rows", "pairs", "samples"),
    "unit": tuple(UNITS),
    "values": tuple(VALUES),
    "scale": (
        "fraction", "stated fraction", "percent", "percent in label",
        "percent in comment", "percent in key",
        "percent in cells",
    ),
    "order": ("ascending", "descending", "shuffled"),
    "separator": (",", ";", "\t", " "),
    "decimal": (".", ","),
    "mark": ("none", *MARKS),
    "preamble": ("none", "keys", "program", "numbers"),
    "head": ("names", "none", "two rows"),
    "ending": (
        "plain", "blank lines", "trailing separators", "footer", "crlf", "utf-16",
    ),
}  # fmt: skip


IMPOSSIBLE = (
    {"decimal": [","], "separator": [","]},
    {"separator": [" "], "mark": [""]},  # a gap
    {"scale": ["percent"], "values": ["dark"]},  # the file does not state it
    {"layout": ["rows", "pairs", "samples"], "head": ["none", "two rows"]},
    {"head": ["none"], "scale": ["percent in label"]},
    {"layout": ["rows"], "unit": ["plain um", "wave number"]},  # not in such labels
    {"head": ["none"], "unit": ["um", "angstrom", "metre", "wave number"]},
    {"layout": ["samples"], "preamble": ["keys", "program", "numbers"]},
    {"ending": ["trailing separators"], "separator": [" "]},
)
"""Choices that no program combines, or that the reader cannot know."""


def combines(writing: Writing, choices: dict[str, list[str]]) -> bool:
    """Whether a table is written with all of these choices."""
    return all(getattr(writing, name) in options for name, options in choices.items())


def is_possible(writing: Writing) -> bool:
    """Whether programs write such tables, and the reader can know it."""
    return not any(combines(writing, choices) for choices in IMPOSSIBLE)


def draw(generator: np.random.Generator) -> Writing:
    """Draw a writing; half of its properties are the usual ones."""
    while True:
        changes = {
            name: str(generator.choice(options))
            for name, options in CHOICES.items()
            if generator.random() < 0.5
        }
        writing = replace(Writing(), **changes)
        if is_possible(writing):
            return writing


def spectra(writing: Writing, generator: np.random.Generator) -> dict[str, np.ndarray]:
    """Return smooth reflectances by name, with four decimals in percent."""
    low, high = VALUES[writing.values]
    count = 1 if writing.head == "none" else 3
    reflectances = {}
    for name in ("ochre", "umber 2", "grey 50%")[:count]:
        centre = generator.uniform(450, 650)
        width = generator.uniform(30, 90)
        shape = 1 / (1 + np.exp((centre - NM) / width))
        label = name.replace(" ", "_") if writing.separator == " " else name
        reflectances[label] = np.round(low + (high - low) * shape, 6)
    return reflectances


def write(
    writing: Writing,
    reflectances: dict[str, np.ndarray],
    generator: np.random.Generator,
) -> bytes:
    """Return the bytes of a table."""
    order = np.arange(len(NM))
    if writing.order == "descending":
        order = order[::-1]
    elif writing.order == "shuffled":
        order = generator.permutation(order)
    nm = NM[order]
    columns = {
        name: _cells(values[order], nm, writing)
        for name, values in reflectances.items()
    }
    label = UNITS[writing.unit][1]
    suffix = " (%R)" if writing.scale == "percent in label" else ""
    if writing.separator == " ":
        label = label.replace(" ", "")
        suffix = suffix.strip()
    table = _table(writing, label, _waves(nm, writing), columns, suffix)
    end = writing.separator * 3 if writing.ending == "trailing separators" else ""
    lines = [*_preamble(writing), *(writing.separator.join(row) + end for row in table)]
    if writing.ending == "footer":
        lines += ["", "End of data", "Checked by: A. Person"]
    newline = {"blank lines": "\n\n", "crlf": "\r\n"}.get(writing.ending, "\n")
    encoding = {"crlf": "utf-8-sig", "utf-16": "utf-16"}.get(writing.ending, "utf-8")
    return "".join(line + newline for line in lines).encode(encoding)


def _waves(nm: np.ndarray, writing: Writing) -> list[str]:
    """Return wavelengths or wave numbers as texts."""
    factor = UNITS[writing.unit][0]
    if writing.unit == "metre":
        return [f"{wave * 1e-9:.4e}".replace(".", writing.decimal) for wave in nm]
    values = 1e7 / nm if factor is None else nm * factor
    return [_number(value, writing) for value in values]


def _preamble(writing: Writing) -> Iterator[str]:
    if writing.scale == "percent in comment":
        yield "# reflectance in percent"
    if writing.scale == "stated fraction":
        yield "# reflectance, values 0-1"
    if writing.preamble == "keys":
        yield from (
            "Instrument: S-1",
            "Integration time: 120 ms",
            "Date: 2020-01-02",
            "",
        )
    elif writing.preamble == "program":
        yield from ("Data from paint Node", "User: u", "Averages: 3")
    elif writing.preamble == "numbers":
        yield from (
            f"Range{writing.separator}350{writing.separator}900",
            f"Slit{writing.separator}2",
        )
    if writing.scale == "percent in key":
        yield "Y Units: Reflectance (percentage)"
    if writing.preamble == "program":
        yield ">>>>>Begin Spectral Data<<<<<"


def _number(value: float, writing: Writing) -> str:
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return text.replace(".", writing.decimal)


def _cells(values: np.ndarray, nm: np.ndarray, writing: Writing) -> list[str]:
    factor = 1 if writing.scale in ("fraction", "stated fraction") else 100
    unit = ""
    if writing.scale == "percent in cells":
        unit = "%" if writing.separator == " " else " %"
    texts = [_number(value * factor, writing) + unit for value in values]
    if writing.mark != "none":
        is_marked = (nm < 370) | (nm > 840)
        for row in np.flatnonzero(is_marked):
            texts[row] = writing.mark
    return texts


def _table(
    writing: Writing,
    label: str,
    waves: list[str],
    columns: dict[str, list[str]],
    suffix: str,
) -> Iterator[list[str]]:
    if writing.layout == "rows":
        unit = {"um": "um", "angstrom": "Å"}.get(writing.unit, "")
        yield [f"name{suffix}", *(f"{wave}{unit}" for wave in waves)]
        for name, cells in columns.items():
            yield [name, *cells]
        return
    if writing.layout == "samples":
        yield ["Sample", label, f"Reflectance{suffix}"]
        for name, cells in columns.items():
            yield from ([name, *pair] for pair in zip(waves, cells, strict=True))
        return
    yield from _table_of_columns(writing, label, waves, columns, suffix)


def _table_of_columns(
    writing: Writing,
    label: str,
    waves: list[str],
    columns: dict[str, list[str]],
    suffix: str,
) -> Iterator[list[str]]:
    heads = [f"{name}{suffix}" for name in columns]
    rows = list(zip(waves, *columns.values(), strict=True))
    if writing.layout == "pairs":
        for first, *others in [(label, *heads), *rows]:
            yield list(chain.from_iterable((first, other) for other in others))
        return
    if writing.head == "two rows":
        yield ["Sample", *columns]
        heads = [f"R{suffix}"] * len(columns)
    if writing.head != "none":
        yield [label, *heads]
    yield from map(list, rows)


def check(seed: int, folder: Path) -> str:
    """Return 'read' for the table of a seed, or the code of the error. Raise
    `AssertionError` for other values.
    """
    generator = np.random.default_rng(seed)
    writing = draw(generator)
    reflectances = spectra(writing, generator)
    path = folder / "table.txt"
    path.write_bytes(write(writing, reflectances, generator))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        try:
            atlas = read_atlas(path)
        except AtlasError as error:
            return error.code
    assert is_same(atlas, writing, reflectances), f"{seed}: {writing}: {atlas.entries}"
    return "read"


def is_same(
    atlas: Atlas, writing: Writing, reflectances: dict[str, np.ndarray]
) -> bool:
    """Whether an atlas has the spectra that were written, up to their rounding."""
    if len(atlas) != len(reflectances):
        return False
    for entry, (name, values) in zip(atlas, reflectances.items(), strict=True):
        expected = np.interp(entry.wavelengths, NM, values)
        covers = entry.wavelengths[0] <= 380 and entry.wavelengths[-1] >= 780
        is_named = writing.head == "none" or entry.name.startswith(name)
        error = np.abs(entry.values - expected).max()
        if not (covers and is_named and error < ROUNDING):
            return False
    return True


if __name__ == "__main__":
    first, last = map(int, sys.argv[1:])
    with tempfile.TemporaryDirectory() as name:
        print(dict(Counter(check(seed, Path(name)) for seed in range(first, last))))
