"""The smoothest spectrum of a colour, by optimisation: Meng, Simon, Hanika & Dachsbacher 2015, in colour-science."""

from __future__ import annotations

from uplift.colorimetry.observer import aligned, colour_science
from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, nbytes, one_by_one
from uplift.lab.chart.task import Task

STEP = 10.0
"""nm; twice as many unknowns take three times as long."""


def prepare(task: Task) -> PreparedMethod:
    convert = colour_science().recovery.XYZ_to_sd_Meng2015
    cmfs, light = aligned(task.sensor, step=STEP)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        found = convert(task.sensor.xyz(rgb), cmfs, light)
        return found.wavelengths, found.values

    return PreparedMethod(one_by_one(spectrum), nbytes((cmfs.values, light.values)))


FAMILIES = (
    Family(
        "Meng 2015",
        "Meng, Simon, Hanika & Dachsbacher, Physically meaningful rendering using tristimulus colours, CGF 34(4), 2015",
        "#8c5a2b",
        (
            Method(
                "meng2015",
                "Meng 2015",
                prepare,
                Claims(round_trip=0.5, most=1000.0),
                batch=False,
                note=f"colour-science at {STEP:g} nm, between which we interpolate; may reflect more than it gets",
            ),
        ),
    ),
)
