"""Tables of known spectra in all combinations of how programs write them: units,
scales, orders, separators, marks.

A reader gives the same spectra, or refuses the table; it never gives other values.
"""

import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

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
"""Properties of a table; the first of each is the usual one."""


REMARKS = {
    "percent in comment": "# reflectance in percent",
    "stated fraction": "# reflectance, values 0-1",
    "percent in key": "Y Units: Reflectance (percentage)",
}
"""Lines that state the scale."""
PREAMBLES = {
    "keys": "Instrument: S-1\nIntegration time: 120 ms\nDate: 2020-01-02\n\n",
    "program": "Data from paint Node\nUser: u\n>>>>>Begin Spectral Data<<<<<",
    "numbers": "Range{0}350{0}900\nSlit{0}2",
}
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


def is_possible(writing: SimpleNamespace) -> bool:
    """Whether programs write such tables, and the reader can know it."""
    return not any(map(partial(has_choices, writing), IMPOSSIBLE))


def has_choices(writing: SimpleNamespace, choices: Mapping[str, Any]) -> bool:
    """Whether all of the named properties are among some options."""
    return all(getattr(writing, name) in options for name, options in choices.items())


def draw(generator: np.random.Generator) -> SimpleNamespace:
    """Draw a writing; half of its properties are the usual ones."""
    while True:
        writing = SimpleNamespace()
        for name, options in CHOICES.items():
            usual = generator.random() < 0.5
            value = options[0] if usual else str(generator.choice(options))
            setattr(writing, name, value)
        if is_possible(writing):
            return writing


def spectra(
    writing: SimpleNamespace, generator: np.random.Generator
) -> dict[str, np.ndarray]:
    """Return smooth reflectances by name, with four decimals in percent."""
    low, high = VALUES[writing.values]
    count = 1 if writing.head == "none" else 3
    reflectances = {}
    for name in ("ochre", "umber 2", "grey 50%")[:count]:
        centre = generator.uniform(450, 650)
        width = generator.uniform(30, 90)
        shape = 1 / (1 + np.exp((centre - NM) / width))
        reflectances[_word(name, writing)] = np.round(low + (high - low) * shape, 6)
    return reflectances


def write(
    writing: SimpleNamespace,
    reflectances: dict[str, np.ndarray],
    generator: np.random.Generator,
) -> bytes:
    """Return the bytes of a table."""
    order = {
        "ascending": np.arange(len(NM)),
        "descending": np.arange(len(NM))[::-1],
        "shuffled": generator.permutation(len(NM)),
    }[writing.order]
    columns = {
        name: _cells(values[order], NM[order], writing)
        for name, values in reflectances.items()
    }
    end = writing.separator * 3 if writing.ending == "trailing separators" else ""
    lines = REMARKS.get(writing.scale, "").splitlines()
    lines += PREAMBLES.get(writing.preamble, "").format(writing.separator).splitlines()
    table = _table(writing, _waves(NM[order], writing), columns)
    lines += [writing.separator.join(row) + end for row in table]
    if writing.ending == "footer":
        lines += ["", "End of data", "Checked by: A. Person"]
    newline = {"blank lines": "\n\n", "crlf": "\r\n"}.get(writing.ending, "\n")
    encoding = {"crlf": "utf-8-sig", "utf-16": "utf-16"}.get(writing.ending, "utf-8")
    return "".join(line + newline for line in lines).encode(encoding)


def _waves(nm: np.ndarray, writing: SimpleNamespace) -> list[str]:
    """Return wavelengths or wave numbers as texts."""
    factor = UNITS[writing.unit][0]
    if writing.unit == "metre":
        return [f"{wave * 1e-9:.4e}".replace(".", writing.decimal) for wave in nm]
    values = 1e7 / nm if factor is None else nm * factor
    return [_number(value, writing) for value in values]


def _number(value: float, writing: SimpleNamespace) -> str:
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return text.replace(".", writing.decimal)


def _cells(values: np.ndarray, nm: np.ndarray, writing: SimpleNamespace) -> list[str]:
    factor = 1 if "fraction" in writing.scale else 100
    unit = " %" if writing.scale == "percent in cells" else ""
    texts = [
        writing.mark
        if writing.mark != "none" and not 370 <= wave <= 840
        else _number(value * factor, writing) + unit
        for wave, value in zip(nm, values, strict=True)
    ]
    return [_word(text, writing) for text in texts]


def _word(text: str, writing: SimpleNamespace) -> str:
    """Return a text without blanks if these separate."""
    return text.replace(" ", "") if writing.separator == " " else text


def _table(
    writing: SimpleNamespace, waves: list[str], columns: dict[str, list[str]]
) -> Iterator[Sequence[str]]:
    suffix = _word(" (%R)" * (writing.scale == "percent in label"), writing)
    label = _word(UNITS[writing.unit][1], writing)
    heads = [f"{name}{suffix}" for name in columns]
    rows = list(zip(waves, *columns.values(), strict=True))
    match writing.layout:
        case "rows":
            unit = {"um": "um", "angstrom": "Å"}.get(writing.unit, "")
            yield [f"name{suffix}", *(f"{wave}{unit}" for wave in waves)]
            yield from ([name, *cells] for name, cells in columns.items())
        case "samples":
            yield ["Sample", label, f"Reflectance{suffix}"]
            for name, cells in columns.items():
                yield from ([name, *pair] for pair in zip(waves, cells, strict=True))
        case "pairs":
            for first, *others in [(label, *heads), *rows]:
                yield list(chain.from_iterable((first, other) for other in others))
        case _:
            if writing.head == "two rows":
                yield ["Sample", *columns]
                heads = [f"R{suffix}"] * len(columns)
            if writing.head != "none":
                yield [label, *heads]
            yield from rows


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
    assert len(atlas) == len(reflectances), f"{seed}: {writing}"
    for entry, (name, values) in zip(atlas, reflectances.items(), strict=True):
        expected = np.interp(entry.wavelengths, NM, values)
        covers = entry.wavelengths[0] <= 380 and entry.wavelengths[-1] >= 780
        is_named = writing.head == "none" or entry.name.startswith(name)
        error = np.abs(entry.values - expected).max()
        is_same = covers and is_named and error < ROUNDING
        assert is_same, f"{seed}: {writing}: {entry}"
    return "read"


if __name__ == "__main__":
    first, last = map(int, sys.argv[1:])
    with tempfile.TemporaryDirectory() as name:
        print(dict(Counter(check(seed, Path(name)) for seed in range(first, last))))
