"""Emission tables: lamps left out, alone and with their families, for
docs/guides/lights.md.
"""

import re
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np

import uplift
from benchmarks import Row, summary
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import black_body
from uplift.common.arrays import Array
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.fit import nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.emission.prior import fit_lamp_prior, relit_delta_e
from uplift.fit.solver import solve
from uplift.models.minimum_norm import forward_map
from uplift.models.sigmoid import Sigmoid

FAMILIES = {
    "daylight": r"[BC]|I?D\d\d",
    "tungsten": r"A|.*Incandescent",
    "equal energy": r"E",
    "xenon": r"Kinoton.*",
    "halophosphate": r"FL[1-6]|FL3\.[1-3]|(Cool White|Daylight) FL|F34.*",
    "broadband fluorescent": r"FL[7-9]|FL3\.([4-6]|1[2-5])|F40.*|Natural|Thorn.*",
    "three-band fluorescent": (
        r"FL1[0-2]|FL3\.([7-9]|1[01])|F32.*|Philips TL-84|T8 .*|Triphosphor FL"
    ),
    "discharge": r"HP\d|.*HPS\)?|LPS|Mercury|H38.*|MHC.*|Metal Halide",
    "phosphor LED": r"LED-(B|BH|V)\d|PHOS-\d|Phosphor LED.*|Luxeon.*",
    "LED mixture": r"LED-RGB1|[34]-LED.*",
}
"""Patterns of the names of colour-science, by the technology of the lamp."""
LAMP = "lamp"
FAMILY = "family"
TABLE = "emission table"
NEAREST = 8
MIREDS = np.linspace(20, 1000, 981)
"""Reciprocal temperatures in 1/MK of the Planckian radiators that are compared."""


def lamp_family(name: str) -> str:
    """Return the family of a lamp. Raises `ValueError` unless it is in one."""
    (family,) = [
        family for family, pattern in FAMILIES.items() if re.fullmatch(pattern, name)
    ]
    return family


RULES: dict[str, Callable[[str], str]] = {LAMP: str, FAMILY: lamp_family}
"""What the prediction of a lamp must not know: lamps of the same name or family."""


def predict(
    lamps: Lamps, group: Callable[[str], str], **size: int
) -> tuple[Array, Array]:
    """Predict lamps by tables that are built without their groups; return power (L, N)
    and expected errors (L,).
    """
    power = np.empty_like(lamps.power)
    expected = np.empty(len(lamps))
    groups = np.array(list(map(group, lamps.names)))
    for name in np.unique(groups):
        rows = np.flatnonzero(groups == name)
        names = [lamps.names[row] for row in rows]
        table = uplift.build_emission(without=names, **size)
        rgb = table.rgb(lamps.power[rows])
        power[rows] = table.spectrum(rgb)
        expected[rows] = table.expected_error(rgb)
    return power, expected


def by_nearest(lamps: Lamps, uv: Array, radiometry: Array) -> dict[str, Array]:
    """Return the power (L, N) of the nearest other lamp and of the mean of the nearest,
    moved to the colours.
    """
    apart = np.linalg.norm(uv[:, None] - uv, axis=-1)
    np.fill_diagonal(apart, np.inf)
    nearest = lamps.power[np.argsort(apart, axis=1, kind="stable")[:, :NEAREST]]
    priors = {
        "nearest lamp, moved": nearest[:, 0],
        f"mean of the {NEAREST} nearest, moved": nearest.mean(axis=1),
    }
    return {
        name: nearest_lights(prior, uv, radiometry) for name, prior in priors.items()
    }


def sigmoid_times_d65(power: Array, d65: Array) -> Array:
    """Return lights with the RGB of others (n, N) as pbrt-v4 makes them.

    RGB is divided by twice its largest component; a sigmoid reflectance has that colour
    under D65 (N,).

    Pharr, Jakob & Humphreys 2023, "Physically based rendering", 4th edition, section
    4.6.6, RGBIlluminantSpectrum. Jakob & Hanika 2019, eq. 5.
    """
    table = uplift.load_emission()
    radiometry = table.data.radiometry
    sensor = table.rgb_of_xyz(radiometry * (d65 / (d65 @ radiometry[:, 1]))[:, None]).T
    rgb = table.rgb(power)
    model = Sigmoid(0.0, 1.0)
    wavelengths = np.linspace(0.0, 1.0, len(radiometry))
    solution = solve(
        forward_map(model, wavelengths, sensor),
        np.zeros((len(rgb), model.count)),
        rgb / (2 * rgb.max(axis=1, keepdims=True)),
        tolerance=1e-7,
        max_passes=200,
    )
    linear = solution.multipliers @ model.basis(wavelengths).T
    return model.to_reflectance(linear) * d65


def planck(uv: Array, radiometry: Array) -> Array:
    """Return the Planckian radiators of the correlated colour temperatures, moved to
    the chromaticities (n, 2).

    CIE 015:2018, 9.5: the correlated colour temperature, by the distance in CIE 1960
    uv.
    """
    temperatures = 1e6 / MIREDS
    radiators = np.stack(
        [black_body(kelvin, observer.grid()) for kelvin in temperatures]
    )
    apart = (uv[:, None] - chromaticity(radiators @ radiometry)) * (1.0, 2 / 3)
    nearest = radiators[np.linalg.norm(apart, axis=-1).argmin(axis=1)]
    return nearest_lights(nearest, uv, radiometry)


@cache
def predicted(rule: str) -> tuple[Array, Array]:
    """Predict the known lamps by a rule: power (L, N) and expected errors (L,)."""
    return predict(known_lamps(), RULES[rule])


@cache
def surfaces() -> Array:
    """Return the reflectances (24, N) of the ColorChecker."""
    return on_grid(read_atlas("macbeth"), observer.grid())


def relit(power: Array) -> Array:
    """Return the mean ΔE00 (L,) of surfaces under lights in place of the lamps."""
    radiometry = uplift.load_emission().data.radiometry
    lamps = known_lamps().power
    return relit_delta_e(lamps, power, surfaces(), radiometry).mean(axis=1)


def errors() -> Iterator[Row]:
    """Yield the errors of lamps that methods do not know."""
    lamps = known_lamps()
    radiometry = uplift.load_emission().data.radiometry
    uv = chromaticity(lamps.power @ radiometry)
    d65 = lamps.power[lamps.names.index("D65")]
    lights = {(rule, TABLE): predicted(rule)[0] for rule in RULES}
    others = {
        **by_nearest(lamps, uv, radiometry),
        "the prior alone": fit_lamp_prior(lamps.power, surfaces(), radiometry)[1],
        "sigmoid × D65": sigmoid_times_d65(lamps.power, d65),
        "Planck, moved": planck(uv, radiometry),
    }
    lights |= {(LAMP, method): power for method, power in others.items()}
    for (rule, method), power in lights.items():
        delta_e = relit(power)
        median = np.median(delta_e)
        yield {"rule": rule, "method": method, "median": median, **summary(delta_e)}


def calibration() -> Iterator[Row]:
    """Yield expected and measured errors of thirds of the lamps, by expected errors."""
    power, expected = predicted(LAMP)
    measured = relit(power)
    for third in np.array_split(np.argsort(expected, kind="stable"), 3):
        yield {"expected": expected[third].mean(), "measured": measured[third].mean()}


QUESTIONS = {"errors": errors, "calibration": calibration}
