"""The smoothest spectrum of a colour, by numerical optimisation.

Domain: linear sRGB in [0, 1] under D65, as XYZ. Range: reflectance of at least 0, not limited to 1, in steps of 10 nm,
interpolated linearly.

References
----------
Meng, Simon, Hanika & Dachsbacher 2015, "Physically meaningful rendering using tristimulus colours", Computer Graphics
Forum 34(4).
"""

from __future__ import annotations

from uplift.colorimetry.observer import aligned
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod, Task, nbytes, one_by_one, published_srgb

STEP = 10.0
"""nm. With half the step, twice as many unknowns take three times as long."""


def prepare(task: Task) -> PreparedMethod:
    """Prepare the optimisation."""
    convert = colour_science().recovery.XYZ_to_sd_Meng2015
    cmfs, light = aligned(task.sensor, step=STEP)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        distribution = convert(published_srgb().xyz(rgb), cmfs, light)
        return distribution.wavelengths, distribution.values

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
                Claims(round_trip=0.5, max=1000.0),
                batch=False,
                note=f"colour-science at {STEP:g} nm, interpolated; reflectances may exceed 1",
            ),
        ),
    ),
)
