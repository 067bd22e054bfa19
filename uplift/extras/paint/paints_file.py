"""The file of measured paints, paints.toml: written, and read with its values
checked.
"""

from itertools import chain
from operator import attrgetter
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from uplift.atlas.atlas import VISIBLE
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import PaintError
from uplift.common.files import write_text
from uplift.common.text import format_value
from uplift.extras.files.spec import (
    NotNegative,
    NotNegativeRow,
    Row,
    SpecModel,
    check_shape,
    problem,
    read_spec,
)
from uplift.extras.files.toml import toml_text
from uplift.extras.paint.optics import NO_SURFACE, Surface
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.pigments import Pigment

FORMAT: Literal["uplift paints 1"] = "uplift paints 1"
HINT = "fit the paints again"
MAX_PAINTS = 1000
MAX_SAMPLES = 1000
LARGEST = 1e12
"""Largest absorption and scattering, whose squares are finite."""
LARGEST_STEP = 20.0
"""Largest step in nm."""
EVEN = 1e-6
"""Tolerance of even steps in nm."""
RANGE = (300.0, 900.0)
"""Range of wavelengths in nm."""
HEAD = """# Paints by uplift paints fit: absorption and scattering per unit thickness.
# A price of a part may be added to each paint, such as: price = 0.35
"""
ROWS = ("absorption", "scattering", "absorption_errors", "scattering_errors")


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
    values = {
        "format": FORMAT,
        "wavelengths": paints.wavelengths,
        "to_scale": paints.is_to_scale,
        "surface": vars(paints.surface),
        "paints": paints.rows(),
    }
    return f"{HEAD}{toml_text(values)}\n"


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


class _Paint(SpecModel):
    name: Annotated[str, Field(min_length=1, max_length=200)]
    price: NotNegative | None = None
    absorption: NotNegativeRow
    scattering: NotNegativeRow
    absorption_errors: NotNegativeRow | None = None
    scattering_errors: NotNegativeRow | None = None


class _PaintsFile(SpecModel):
    format: Literal["uplift paints 1"]
    wavelengths: Row
    to_scale: bool = True
    surface: Surface = NO_SURFACE
    paints: Annotated[list[_Paint], Field(min_length=1, max_length=MAX_PAINTS)]

    @model_validator(mode="after")
    def _fit_together(self) -> Self:
        if not _are_even(self.wavelengths):
            text = (
                f"must be even steps of at most {LARGEST_STEP:g} nm from "
                f"{VISIBLE[0]:g} to {VISIBLE[1]:g} nm, within {RANGE[0]:g}–{RANGE[1]:g}"
            )
            raise problem(text, at=("wavelengths",))
        names = [paint.name for paint in self.paints]
        for number, paint in enumerate(self.paints):
            at = ("paints", number)
            if len(paint.name.splitlines()) != 1 or "\0" in paint.name:
                text = f"must be one line of text, got {format_value(paint.name)}"
                raise problem(text, at=(*at, "name"))
            if names.count(paint.name) > 1:
                raise problem(f"two paints have the name '{paint.name}'", at=at)
            for key in ROWS:
                values = getattr(paint, key)
                if values is not None:
                    check_shape(values, self.wavelengths.shape, *at, key)
                    if values.max() > LARGEST:
                        raise problem(f"must be at most {LARGEST:g}", at=(*at, key))
            if not (paint.absorption + paint.scattering).all():
                text = f"'{paint.name}' neither absorbs nor scatters at some wavelength"
                raise problem(text, at=at)
        return self

    def pigment(self, absorption: str, scattering: str) -> Pigment | None:
        """Return the rows (P, N) of two keys; None if a paint lacks one."""
        rows = list(map(attrgetter(absorption, scattering), self.paints))
        if any(row is None for row in chain(*rows)):
            return None
        return Pigment(*map(np.array, zip(*rows, strict=True)))


def _are_even(nm: Array) -> bool:
    """Whether wavelengths are in even steps, and cover the visible range."""
    if not 1 < len(nm) <= MAX_SAMPLES:
        return False
    steps = np.diff(nm)
    is_even = 0 < steps[0] <= LARGEST_STEP and np.ptp(steps) < EVEN
    starts = RANGE[0] <= nm[0] <= VISIBLE[0]
    return bool(is_even and starts and VISIBLE[1] <= nm[-1] <= RANGE[1])


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
    file = read_spec(path, _PaintsFile, PaintError, hint=HINT)
    pigments = file.pigment("absorption", "scattering")
    assert pigments is not None
    prices = np.array([paint.price for paint in file.paints], dtype=float)
    return Paints(
        tuple(paint.name for paint in file.paints),
        file.wavelengths,
        pigments,
        file.surface,
        file.pigment("absorption_errors", "scattering_errors"),
        tuple(prices.tolist()) if np.isfinite(prices).any() else (),
        file.to_scale,
    )
