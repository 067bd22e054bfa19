"""Tables of known spectra in all combinations of how programs write them: units,
scales, orders, separators, marks.

A reader gives the same spectra, or refuses the table; it never gives other values.
"""

import itertools
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from itertools import chain
from pathlib import Path

import numpy as np

from uplift.atlas import Atlas, read_atlas
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


def is_possible(writing: Writing) -> bool:
    """Whether programs write such tables, and the reader can know it."""
    if writing.decimal == writing.separator:
        return False
    if writing.separator == " " and writing.mark == "":
        return False  # a gap
    if writing.scale == "percent" and writing.values == "dark":
        return False  # the file does not state it
    if writing.layout != "columns" and writing.head != "names":
        return False
    if writing.head == "none" and writing.scale == "percent in label":
        return False
    if writing.layout == "rows" and writing.unit in ("plain um", "wave number"):
        return False  # labels of a row state no such unit
    if writing.head == "none" and writing.unit not in ("nm", "plain", "plain um"):
        return False
    if writing.layout == "samples" and writing.preamble != "none":
        return False
    return not (writing.ending == "trailing separators" and writing.separator == " ")


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
    found = {}
    for name in ("ochre", "umber 2", "grey 50%")[:count]:
        centre = generator.uniform(450, 650)
        width = generator.uniform(30, 90)
        shape = 1 / (1 + np.exp((centre - NM) / width))
        found[name.replace(" ", "_") if writing.separator == " " else name] = np.round(
            low + (high - low) * shape, 6
        )
    return found


def write(
    writing: Writing,
    reflectances: dict[str, np.ndarray],
    generator: np.random.Generator,
) -> bytes:
    """Return the bytes of a table."""
    lines = list(_preamble(writing))
    order = {"ascending": slice(None), "descending": slice(None, None, -1)}.get(
        writing.order
    )
    order = generator.permutation(len(NM)) if order is None else order
    factor, label = UNITS[writing.unit]
    nm = NM[order]
    waves = [
        _number(1e7 / each if factor is None else each * factor, 6, writing)
        for each in nm
    ]
    if factor == 1e-9:
        waves = [f"{each * 1e-9:.4e}".replace(".", writing.decimal) for each in nm]
    columns = {
        name: _cells(values[order], nm, writing)
        for name, values in reflectances.items()
    }
    suffix = " (%R)" if writing.scale == "percent in label" else ""
    suffix = suffix.strip() if writing.separator == " " else suffix
    label = label.replace(" ", "") if writing.separator == " " else label
    table = list(_table(writing, label, waves, columns, suffix))
    end = writing.separator * 3 if writing.ending == "trailing separators" else ""
    lines += [writing.separator.join(row) + end for row in table]
    if writing.ending == "footer":
        lines += ["", "End of data", "Checked by: A. Person"]
    if writing.ending == "blank lines":
        lines = list(itertools.chain.from_iterable((line, "") for line in lines))
    text = "\n".join(lines) + "\n"
    if writing.ending == "crlf":
        return text.replace("\n", "\r\n").encode("utf-8-sig")
    return text.encode("utf-16" if writing.ending == "utf-16" else "utf-8")


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


def _number(value: float, digits: int, writing: Writing) -> str:
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return text.replace(".", writing.decimal)


def _cells(values: np.ndarray, nm: np.ndarray, writing: Writing) -> list[str]:
    in_percent = writing.scale not in ("fraction", "stated fraction")
    texts = [
        _number(value * (100 if in_percent else 1), 6, writing) for value in values
    ]
    if writing.scale == "percent in cells":
        texts = [
            f"{text}%" if writing.separator == " " else f"{text} %" for text in texts
        ]
    if writing.mark != "none":
        texts = [
            writing.mark if each < 370 or each > 840 else text
            for each, text in zip(nm, texts, strict=True)
        ]
    return texts


def _table(
    writing: Writing,
    label: str,
    waves: list[str],
    columns: dict[str, list[str]],
    suffix: str,
) -> Iterator[list[str]]:
    names = list(columns)
    if writing.layout == "rows":
        unit = {"um": "um", "angstrom": "Å"}.get(writing.unit, "")
        yield [f"name{suffix}", *(f"{wave}{unit}" for wave in waves)]
        for name, cells in columns.items():
            yield [name, *cells]
    elif writing.layout == "samples":
        yield ["Sample", label, f"Reflectance{suffix}"]
        for name, cells in columns.items():
            for wave, cell in zip(waves, cells, strict=True):
                yield [name, wave, cell]
    elif writing.layout == "pairs":
        yield list(chain.from_iterable((label, f"{name}{suffix}") for name in names))
        for row, wave in enumerate(waves):
            yield list(
                chain.from_iterable((wave, columns[name][row]) for name in names)
            )
    else:
        if writing.head == "two rows":
            yield ["Sample", *names]
            yield [label, *(f"R{suffix}" for _ in names)]
        elif writing.head == "names":
            yield [label, *(f"{name}{suffix}" for name in names)]
        for row, wave in enumerate(waves):
            yield [wave, *(columns[name][row] for name in names)]


def describe(writing: Writing) -> str:
    """Return what differs from the usual writing."""
    usual = Writing()
    changed = [
        each.name
        for each in fields(Writing)
        if getattr(writing, each.name) != getattr(usual, each.name)
    ]
    return ", ".join(f"{name}={getattr(writing, name)!r}" for name in changed)


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
    assert is_same(atlas, writing, reflectances), (
        f"{seed}: {describe(writing)}: {atlas.entries}"
    )
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
        if not (
            covers and is_named and np.abs(entry.values - expected).max() < ROUNDING
        ):
            return False
    return True


if __name__ == "__main__":
    first, last = map(int, sys.argv[1:])
    with tempfile.TemporaryDirectory() as name:
        print(dict(Counter(check(seed, Path(name)) for seed in range(first, last))))
