"""Seven hand-made spectra of ten bins: Smits 1999, An RGB-to-spectrum conversion for reflectances.

The table is colour-science's. It was made for an equal-energy white; renderers feed it sRGB as it is, and so do we.
"""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.observer import colour_science
from uplift.common.arrays import Array
from uplift.lab.chart.method import Claims, Family, Method, PreparedMethod
from uplift.lab.chart.task import Task

SECONDARIES, PRIMARIES = ("cyan", "magenta", "yellow"), ("red", "green", "blue")
"""By the component that is least, and by that which is most."""


def prepare(task: Task) -> PreparedMethod:
    table = colour_science().recovery.SDS_SMITS1999
    centres = table["white"].wavelengths
    white, secondaries, primaries = (
        np.stack([table[name].values for name in names]) for names in (("white",), SECONDARIES, PRIMARIES)
    )

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        order = rgb.argsort(axis=1)
        least, middle, most = np.take_along_axis(rgb, order, axis=1).T[..., None]
        bins = (
            least * white
            + (middle - least) * secondaries[order[:, 0]]
            + (most - middle) * primaries[order[:, 2]]
        )
        return bins @ _linear(wavelengths, centres)

    return PreparedMethod(uplift, white.nbytes + secondaries.nbytes + primaries.nbytes)


def _linear(wavelengths: Array, centres: Array) -> Array:
    """(10, N) shares of the bins in a spectrum that is linear between their centres."""
    return np.stack([np.interp(wavelengths, centres, one) for one in np.eye(len(centres))])


FAMILIES = (
    Family(
        "Smits 1999",
        "Smits, An RGB-to-spectrum conversion for reflectances, Journal of Graphics Tools 4(4), 1999",
        "#7a9a1d",
        (
            Method(
                "smits1999",
                "Smits 1999",
                prepare,
                Claims(most=1.02),
                quick=True,
                note="the table of colour-science, sRGB taken as it is; reflectances up to 1.015",
            ),
        ),
    ),
)
