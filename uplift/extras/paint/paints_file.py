"""The file of measured paints, paints.toml: written, and read with its values
checked.
"""

from collections.abc import Iterator
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from uplift.atlas.atlas import VISIBLE
from uplift.common.arrays import StrPath
from uplift.common.errors import PaintError
from uplift.common.files import write_text
from uplift.common.text import format_value
from uplift.extras.files.spec import SpecModel, problem, read_toml
from uplift.extras.files.toml import number_value, row_value, text_value
from uplift.extras.paint.optics import Surface
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment

FORMAT: Literal["uplift paints 1"] = "uplift paints 1"
HINT = "fit the paints again"
MAX_PAINTS = 1000
MAX_SAMPLES = 1000
LARGEST_STEP = 20.0
"""Largest step in nm."""
EVEN = 1e-6
"""Tolerance of even steps in nm."""
HEAD = """# Paints by uplift paints fit: absorption and scattering per unit thickness.
# A price of a part may be added to each paint, such as: price = 0.35
"""


def to_toml(paints: Paints) -> str:
    """Write paints as the text of a TOML file.

    Parameters
    ----------
    paints : Paints
        The paints.

    Returns
    -------
    str
        The text; `read_paints` reads it.
    """
    return HEAD + "\n".join(_lines(paints)) + "\n"


def _lines(paints: Paints) -> Iterator[str]:
    yield f"format = {text_value(FORMAT)}"
    yield f"wavelengths = {row_value(paints.wavelengths)}"
    yield f"to-scale = {str(paints.is_to_scale).lower()}"
    yield ""
    yield "[surface]"
    yield f"outside = {number_value(paints.surface.outside)}"
    yield f"inside = {number_value(paints.surface.inside)}"
    for row, name in enumerate(paints.names):
        yield ""
        yield "[[paints]]"
        yield f"name = {text_value(name)}"
        if paints.prices and np.isfinite(paints.prices[row]):
            yield f"price = {number_value(paints.prices[row])}"
        yield f"absorption = {row_value(paints.pigments.absorption[row])}"
        yield f"scattering = {row_value(paints.pigments.scattering[row])}"
        if paints.errors is not None:
            yield f"absorption-errors = {row_value(paints.errors.absorption[row])}"
            yield f"scattering-errors = {row_value(paints.errors.scattering[row])}"


def write_paints(paints: Paints, path: StrPath, *, force: bool = False) -> None:
    """Write paints to a TOML file, atomically.

    Parameters
    ----------
    paints : Paints
        The paints.
    path : path-like
        File to write.
    force : bool
        Whether to replace an existing file.

    Raises
    ------
    OutputError
        The file cannot be written, or exists and ``force`` is off.
    """
    write_text(to_toml(paints), path, force=force)


_Positive = Annotated[float, Field(allow_inf_nan=False, ge=0, le=1e12)]
_Wavelength = Annotated[float, Field(allow_inf_nan=False, ge=300, le=900)]
_Fraction = Annotated[float, Field(ge=0, lt=1)]
_Row = Annotated[list[_Positive], Field(min_length=2, max_length=MAX_SAMPLES)]
_Wavelengths = Annotated[list[_Wavelength], Field(min_length=2, max_length=MAX_SAMPLES)]


class _SurfaceTable(SpecModel):
    outside: _Fraction = 0.0
    inside: _Fraction = 0.0


class _PaintTable(SpecModel):
    name: Annotated[str, Field(min_length=1, max_length=200)]
    price: _Positive | None = None
    absorption: _Row
    scattering: _Row
    absorption_errors: _Row | None = None
    scattering_errors: _Row | None = None


class _PaintsTable(SpecModel):
    format: Literal["uplift paints 1"]
    wavelengths: _Wavelengths
    to_scale: bool = True
    surface: _SurfaceTable = _SurfaceTable()
    paints: Annotated[list[_PaintTable], Field(min_length=1, max_length=MAX_PAINTS)]

    @model_validator(mode="after")
    def _sizes_agree(self) -> Self:
        steps = np.diff(self.wavelengths)
        if not (0 < steps[0] <= LARGEST_STEP and np.ptp(steps) < EVEN):
            raise problem(
                f"wavelengths must ascend in even steps of at most {LARGEST_STEP:g} nm"
            )
        first, last = self.wavelengths[0], self.wavelengths[-1]
        if first > VISIBLE[0] or last < VISIBLE[1]:
            raise problem(
                f"wavelengths must cover {VISIBLE[0]:g} to {VISIBLE[1]:g} nm, got "
                f"{first:g} to {last:g} nm"
            )
        names = [paint.name for paint in self.paints]
        for name in names:
            if len(name.splitlines()) != 1 or "\0" in name:
                raise problem(
                    f"name must be one line of text, got {format_value(name)}"
                )
            if names.count(name) > 1:
                raise problem(f"two paints have the name '{name}'", "rename one")
        for paint in self.paints:
            self._check_rows(paint)
        return self

    def _check_rows(self, paint: _PaintTable) -> None:
        rows = [paint.absorption, paint.scattering]
        errors = [paint.absorption_errors, paint.scattering_errors]
        rows += [row for row in errors if row is not None]
        for row in rows:
            if len(row) != len(self.wavelengths):
                raise problem(
                    f"paint '{paint.name}' must have {len(self.wavelengths)} values a "
                    f"row, one per wavelength, got {len(row)}"
                )
        if not np.add(paint.absorption, paint.scattering).all():
            raise problem(
                f"paint '{paint.name}' neither absorbs nor scatters at some wavelength"
            )


def read_paints(path: StrPath) -> Paints:
    """Read a file of paints.

    Parameters
    ----------
    path : path-like
        A TOML file that `write_paints` wrote, or one written by hand.

    Returns
    -------
    Paints

    Raises
    ------
    PaintError
        The file cannot be read or a value does not fit; the error names the key.
    """
    table = read_toml(path, PaintError).validate(_PaintsTable, hint=HINT)
    tables = table.paints
    pigments = Pigment(
        np.array([paint.absorption for paint in tables]),
        np.array([paint.scattering for paint in tables]),
    )
    errors = None
    if all(paint.absorption_errors and paint.scattering_errors for paint in tables):
        errors = Pigment(
            np.array([paint.absorption_errors for paint in tables]),
            np.array([paint.scattering_errors for paint in tables]),
        )
    prices = [np.nan if paint.price is None else paint.price for paint in tables]
    return Paints(
        tuple(paint.name for paint in tables),
        np.array(table.wavelengths),
        pigments,
        Surface(table.surface.outside, table.surface.inside),
        errors,
        tuple(prices) if np.isfinite(prices).any() else (),
        table.to_scale,
    )
