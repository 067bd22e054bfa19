"""Principal components of clusters of measured spectra, three per cluster.

Domain: linear sRGB in [0, 1] under D65, as XYZ. Range: reflectance clipped to [0, 1], interpolated linearly from the
wavelengths of the published data, those of colour-science.

References
----------
Otsu, Yamamoto & Hachisuka 2018, "Reproducing spectral reflectances from tristimulus colours", Computer Graphics Forum
37(6).
"""

from __future__ import annotations

from uplift.colorimetry.observer import aligned
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.lab.chart.method import Family, Method, PreparedMethod, Task, nbytes, one_by_one, published_srgb


def prepare(task: Task) -> PreparedMethod:
    """Prepare the published data."""
    otsu = colour_science().recovery.otsu2018
    shape = otsu.SPECTRAL_SHAPE_OTSU2018
    cmfs, light = aligned(task.sensor, shape.start, shape.end, shape.interval)

    def spectrum(rgb: Array) -> tuple[Array, Array]:
        distribution = otsu.XYZ_to_sd_Otsu2018(published_srgb().xyz(rgb), cmfs, light)
        return distribution.wavelengths, distribution.values

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
                note="colour-science with its own data, clipped to [0, 1]",
            ),
        ),
    ),
)
