"""Published methods in Python: Jakob 2019, Mallett 2019, Meng 2015, Otsu 2018 and Smits
1999.

Domain: linear sRGB in [0, 1] under D65; Smits was made for an equal-energy white and is
used with sRGB as renderers do. Range: reflectance in [0, 1], of Smits up to 1.015, of
Meng not limited to 1. Spectra in steps of up to 10 nm are interpolated linearly. All
use the tables and programs of colour-science.

Smits 1999, "An RGB-to-spectrum conversion for reflectances", Journal of Graphics Tools
4(4). Meng, Simon, Hanika & Dachsbacher 2015, "Physically meaningful rendering using
tristimulus colours", CGF 34(4). Otsu, Yamamoto & Hachisuka 2018, "Reproducing spectral
reflectances from tristimulus colours", CGF 37(6). Mallett & Yuksel 2019, "Spectral
primary decomposition for rendering with sRGB reflectance", EGSR. Jakob & Hanika 2019,
"A low-dimensional function space for efficient spectral upsampling", CGF 38(2).
"""

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from uplift.colorimetry.observer import END, START, STEP
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.tables import aligned, look_up
from uplift.common.arrays import Array, Values
from uplift.common.colour_science import colour_science
from uplift.extras.timing import stopwatch
from uplift.lab.method import (
    Method,
    PreparedMethod,
    in_float32,
    nbytes,
    published_srgb,
    stated_sensor,
)
from uplift.lab.methods import mitsuba3
from uplift.lab.runner import Task
from uplift.models.sigmoid import evaluate_unscaled

MENG_STEP = 10.0
"""nm. With half the step, twice as many unknowns take three times as long."""
OTSU_GRID = (380.0, 730.0, 10.0)


def prepare_one_by_one(
    task: Task, name: str, grid: tuple[float, float, float] = (START, END, STEP)
) -> PreparedMethod:
    """Prepare a function of colour-science from one XYZ, an observer and an illuminant
    to a spectrum.
    """
    recovery = colour_science().recovery
    convert = getattr(recovery, name)
    named = ("observer", task.sensor.observer), ("illuminant", task.sensor.illuminant)
    cmfs, light = (aligned(kind, look_up(kind, title), *grid) for kind, title in named)

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        rows = []
        for xyz in published_srgb().xyz(rgb):
            spectrum = convert(xyz, cmfs, light)
            rows.append(np.interp(wavelengths, spectrum.wavelengths, spectrum.values))
        return np.stack(rows)

    otsu = recovery.otsu2018
    clusters = (
        otsu.BASIS_FUNCTIONS_OTSU2018,
        otsu.CLUSTER_MEANS_OTSU2018,
        otsu.SELECTOR_ARRAY_OTSU2018,
    )
    tables = clusters if grid == OTSU_GRID else (cmfs.values, light.values)
    return PreparedMethod(uplift, nbytes(*tables))


def prepare_jakob_table(task: Task) -> PreparedMethod:
    """Let colour-science read the table of 64 that is part of Mitsuba 3."""
    path = mitsuba3.table_file()
    table = colour_science().recovery.LUT3D_Jakob2019()
    _, run = stopwatch(lambda: table.read(str(path)))

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        # For one colour the coefficients have no axis of colours.
        coefficients = table.RGB_to_coefficients(rgb).reshape(-1, 3)
        return evaluate_unscaled(coefficients, wavelengths)

    return PreparedMethod(uplift, table.coefficients.nbytes, None, run.cpu)


def prepare_basis(
    task: Task,
    read: Callable[[], tuple[Array, Array]],
    weights: Callable[[Values], Values],
) -> PreparedMethod:
    """Prepare a method whose spectra are sums of K basis spectra; ``weights`` has
    shapes (n, 3) to (n, K).
    """
    (centres, basis), run = stopwatch(read)

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        at = np.stack([np.interp(wavelengths, centres, row) for row in basis])
        return weights(rgb) @ at.astype(rgb.dtype, copy=False)

    return PreparedMethod(uplift, basis.nbytes, load_s=run.cpu)


def _mallett_basis() -> tuple[Array, Array]:
    primaries = colour_science().recovery.MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019
    return primaries.wavelengths, np.ascontiguousarray(primaries.values.T)


def _smits_basis() -> tuple[Array, Array]:
    table = colour_science().recovery.SDS_SMITS1999
    names = ("white", "cyan", "magenta", "yellow", "red", "green", "blue")
    return table["white"].wavelengths, np.stack([table[name].values for name in names])


def _smits_weights(rgb: Values) -> Values:
    """White by the smallest component, a secondary by the middle one, and a primary by
    the largest: (n, 7).
    """
    order = rgb.argsort(axis=1)
    rows = np.arange(len(rgb))
    low, middle, high = np.take_along_axis(rgb, order, axis=1).T
    weights = np.zeros((len(rgb), 7), rgb.dtype)
    weights[:, 0] = low
    weights[rows, 1 + order[:, 0]] = middle - low
    weights[rows, 4 + order[:, 2]] = high - middle
    return weights


@cache
def smits_sensor() -> Sensor:
    """Return the sensor of the stated space, sRGB with an equal-energy white."""
    space = colour_science().recovery.smits1999.RGB_COLOURSPACE_SMITS1999
    return stated_sensor(space.matrix_XYZ_to_RGB, space.whitepoint_name)


JAKOB = (
    "Jakob & Hanika, A low-dimensional function space for efficient spectral "
    "upsampling, CGF 38(2), 2019"
)
MALLETT = Method(
    method="mallett2019",
    title="Mallett 2019",
    source=(
        "Mallett & Yuksel, Spectral primary decomposition for rendering with sRGB "
        "reflectance, EGSR 2019"
    ),
    prepare=partial(prepare_basis, read=_mallett_basis, weights=np.asarray),
    claimed_error=0.01,
    claimed_range=(0, 1 + 1e-6),
    note="basis of colour-science, one product of matrices",
)
SMITS = Method(
    method="smits1999",
    title="Smits 1999",
    source=(
        "Smits, An RGB-to-spectrum conversion for reflectances, Journal of Graphics "
        "Tools 4(4), 1999"
    ),
    prepare=partial(prepare_basis, read=_smits_basis, weights=_smits_weights),
    claimed_range=(0, 1.02),
    reference_sensor=smits_sensor,
    note="table of colour-science, used with sRGB; reflectances up to 1.015",
)
METHODS = (
    Method(
        method="jakob2019-direct",
        title="Jakob 2019, direct",
        source=JAKOB,
        prepare=partial(prepare_one_by_one, name="XYZ_to_sd_Jakob2019"),
        claimed_error=0.1,
        note="colour-science, which stops at ΔE76 0.024",
    ),
    Method(
        method="jakob2019-table64",
        title="Jakob 2019, table of 64",
        source=JAKOB,
        prepare=prepare_jakob_table,
        claimed_error=0.1,
        reference_sensor=mitsuba3.reference_sensor,
        note="looked up by colour-science in the table of Mitsuba 3",
    ),
    MALLETT,
    in_float32(MALLETT),
    Method(
        method="meng2015",
        title="Meng 2015",
        source=(
            "Meng, Simon, Hanika & Dachsbacher, Physically meaningful rendering using "
            "tristimulus colours, CGF 34(4), 2015"
        ),
        prepare=partial(
            prepare_one_by_one, name="XYZ_to_sd_Meng2015", grid=(START, END, MENG_STEP)
        ),
        claimed_error=0.5,
        claimed_range=(0, 1000),
        note=(
            f"colour-science at {MENG_STEP:g} nm, interpolated; reflectances may "
            "exceed 1"
        ),
    ),
    Method(
        method="otsu2018",
        title="Otsu 2018",
        source=(
            "Otsu, Yamamoto & Hachisuka, Reproducing spectral reflectances from "
            "tristimulus colours, CGF 37(6), 2018"
        ),
        prepare=partial(prepare_one_by_one, name="XYZ_to_sd_Otsu2018", grid=OTSU_GRID),
        note="colour-science with its own data, clipped to [0, 1]",
    ),
    SMITS,
    in_float32(SMITS),
)
