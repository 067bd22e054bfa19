"""Sigmoids of quadratic polynomials, as colour-science fits them.

Domain: linear sRGB in [0, 1] under D65, as XYZ or as RGB of a table. Range: reflectance in [0, 1] at the wavelengths
of the sensor.

References
----------
Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", Computer Graphics Forum
38(2).
"""

from __future__ import annotations

from functools import partial
from typing import Any

from uplift.colorimetry.observer import aligned
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import (
    Claims,
    Family,
    Method,
    PreparedMethod,
    Task,
    nbytes,
    one_by_one,
    published_srgb,
    stopwatch,
)
from uplift.lab.chart.methods.mitsuba3 import judge, table_file
from uplift.models.sigmoid import evaluate_unscaled

SIZE = 5
"""Points along each edge of the 3 × 5³ table that colour-science fits in Python in half a minute; for 64, as published,
it takes many hours."""


def prepare_direct(task: Task) -> PreparedMethod:
    """Prepare a fit for every colour."""
    convert = colour_science().recovery.XYZ_to_sd_Jakob2019
    cmfs, light = aligned(task.sensor)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        distribution = convert(published_srgb().xyz(rgb), cmfs, light)
        return distribution.wavelengths, distribution.values

    return PreparedMethod(one_by_one(spectrum), nbytes((cmfs.values, light.values)))


def prepare_table(task: Task) -> PreparedMethod:
    """Fit a table of coefficients."""
    colour = colour_science()
    table = colour.recovery.LUT3D_Jakob2019()
    space = colour.RGB_COLOURSPACES[task.sensor.space]
    _, seconds = stopwatch(lambda: table.generate(space, *aligned(task.sensor), SIZE, print_callable=lambda *_: None))

    return PreparedMethod(partial(look_up, table), table.coefficients.nbytes, seconds)


def prepare_published_table(task: Task) -> PreparedMethod:
    """Read the table of 64 that is part of Mitsuba 3."""
    path, table = table_file(), colour_science().recovery.LUT3D_Jakob2019()
    _, seconds = stopwatch(lambda: table.read(str(path)))
    return PreparedMethod(partial(look_up, table), table.coefficients.nbytes, None, seconds)


def look_up(table: Any, rgb: Array, wavelengths: Array) -> Array:
    """Interpolate the coefficients of a table of colour-science, and evaluate them."""
    # For one colour the result has no axis of colours.
    return evaluate_unscaled(table.RGB_to_coefficients(rgb).reshape(-1, 3), wavelengths)


FAMILIES = (
    Family(
        "Jakob 2019",
        "Jakob & Hanika, A low-dimensional function space for efficient spectral upsampling, CGF 38(2), 2019",
        "#d1495b",
        (
            Method(
                "jakob2019-direct",
                "Jakob 2019, direct",
                prepare_direct,
                Claims(round_trip=0.1),
                batch=False,
                quick=True,
                note="colour-science, which stops at ΔE76 0.024",
            ),
            Method(
                "jakob2019-table",
                f"Jakob 2019, table of {SIZE}",
                prepare_table,
                usual=False,
                note=f"colour-science, 3 × {SIZE}³ points",
            ),
            Method(
                "jakob2019-table64",
                "Jakob 2019, table of 64",
                prepare_published_table,
                Claims(round_trip=0.1),
                judge=judge,
                quick=True,
                note="looked up by colour-science in the table of Mitsuba 3",
            ),
        ),
    ),
)
