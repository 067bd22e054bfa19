"""Clusters of measured spectra, three principal components each: Otsu, Yamamoto & Hachisuka 2018, by colour-science."""

from __future__ import annotations

from uplift.colorimetry.observer import aligned, colour_science
from uplift.common.arrays import Array
from uplift.lab.chart.method import Family, Method, PreparedMethod, nbytes, one_by_one
from uplift.lab.chart.task import Task


def prepare(task: Task) -> PreparedMethod:
    otsu = colour_science().recovery.otsu2018
    shape = otsu.SPECTRAL_SHAPE_OTSU2018
    cmfs, light = aligned(task.sensor, shape.start, shape.end, shape.interval)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        found = otsu.XYZ_to_sd_Otsu2018(task.sensor.xyz(rgb), cmfs, light)
        return found.wavelengths, found.values

    data = (otsu.BASIS_FUNCTIONS_OTSU2018, otsu.CLUSTER_MEANS_OTSU2018, otsu.SELECTOR_ARRAY_OTSU2018)
    return PreparedMethod(one_by_one(spectrum), nbytes(data))


FAMILIES = (
    Family(
        "Otsu 2018",
        "Otsu, Yamamoto & Hachisuka, Reproducing spectral reflectances from tristimulus colours, CGF 37(6), 2018",
        "#d63fa0",
        (
            Method(
                "otsu2018",
                "Otsu 2018",
                prepare,
                batch=False,
                quick=True,
                note="colour-science with its own data set, clipped to [0, 1]",
            ),
        ),
    ),
)
