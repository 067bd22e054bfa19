"""Sigmoids of quadratic polynomials, as colour-science fits them.

Domain: linear sRGB in [0, 1] under D65, as XYZ or as RGB of a table. Range: reflectance in [0, 1] at the wavelengths
of the sensor.

References
----------
Jakob & Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", Computer Graphics Forum
38(2).
"""

from __future__ import annotations

from uplift.colorimetry.observer import aligned
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, nbytes, one_by_one, stopwatch
from uplift.lab.chart.task import Task
from uplift.models.sigmoid import evaluate_unscaled

SIZE = 5
"""Points along each edge of the 3 × 5³ table: colour-science fits it in Python in half a minute. Published tables
have 64."""


def prepare_direct(task: Task) -> PreparedMethod:
    """Prepare a fit for every colour."""
    convert = colour_science().recovery.XYZ_to_sd_Jakob2019
    cmfs, light = aligned(task.sensor)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        distribution = convert(task.sensor.xyz(rgb), cmfs, light)
        return distribution.wavelengths, distribution.values

    return PreparedMethod(one_by_one(spectrum), nbytes((cmfs.values, light.values)))


def prepare_table(task: Task) -> PreparedMethod:
    """Fit a table of coefficients."""
    colour = colour_science()
    table = colour.recovery.LUT3D_Jakob2019()
    space = colour.RGB_COLOURSPACES[task.sensor.space]
    _, seconds = stopwatch(
        lambda: table.generate(space, *aligned(task.sensor), SIZE, print_callable=lambda *_: None)
    )

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        # For one colour the result has no axis of colours.
        return evaluate_unscaled(table.RGB_to_coefficients(rgb).reshape(-1, 3), wavelengths)

    return PreparedMethod(uplift, table.coefficients.nbytes, seconds)


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
                note="colour-science, which stops at ΔE76 0.024",
            ),
            Method(
                "jakob2019-table",
                f"Jakob 2019, table of {SIZE}",
                prepare_table,
                note=f"colour-science, 3 × {SIZE}³ points; see Mitsuba 3 for a table of 64",
            ),
        ),
    ),
)
