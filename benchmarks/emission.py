"""Emission tables: lamps left out, alone and with their families, for
docs/guides/lights.md.
"""

import re
from collections.abc import Iterator
from functools import cache
from itertools import product

import numpy as np

import uplift
from benchmarks import Row, summary
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import black_body
from uplift.common.arrays import Array, Mask
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.fit import nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.emission.prior import fit_lamp_prior, relit_delta_e
from uplift.fit.solver import solve
from uplift.models import Sigmoid, forward_map

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
SURFACES = {"ColorChecker": "macbeth", "CIE 2017": "cie2017"}
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


def unknown_lamps(lamps: Lamps) -> dict[str, Mask]:
    """Return which lamps (L, L) the prediction of each lamp must not know, by rule."""
    families = np.array([lamp_family(name) for name in lamps.names])
    return {
        LAMP: np.eye(len(lamps), dtype=bool),
        FAMILY: families[:, None] == families,
    }


def predict(lamps: Lamps, unknown: Mask, **size: int) -> tuple[Array, Array]:
    """Predict lamps by tables built without those that a prediction must not know (L,
    L); return power (L, N) and expected errors (L,).
    """
    power = np.empty_like(lamps.power)
    expected = np.empty(len(lamps))
    sets, member = np.unique(unknown, axis=0, return_inverse=True)
    for number, left_out in enumerate(sets):
        names = [lamps.names[row] for row in np.flatnonzero(left_out)]
        table = uplift.build_emission(without=names, **size)
        rows = np.flatnonzero(member.ravel() == number)
        rgb = table.rgb(lamps.power[rows])
        power[rows] = table.spectrum(rgb)
        expected[rows] = table.expected_error(rgb)
    return power, expected


def by_nearest(lamps: Lamps, unknown: Mask, radiometry: Array) -> dict[str, Array]:
    """Return the power (L, N) of the nearest known lamp and of the mean of the nearest,
    moved to the colours.
    """
    uv = chromaticity(lamps.power @ radiometry)
    apart = np.where(unknown, np.inf, np.linalg.norm(uv[:, None] - uv, axis=-1))
    known = lamps.power[np.argsort(apart, axis=1, kind="stable")[:, :NEAREST]]
    mean = known.mean(axis=1)
    return {
        "nearest lamp, moved": nearest_lights(known[:, 0], uv, radiometry),
        f"mean of the {NEAREST} nearest, moved": nearest_lights(mean, uv, radiometry),
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
    lamps = known_lamps()
    return predict(lamps, unknown_lamps(lamps)[rule])


def relit(power: Array, atlas: str) -> Array:
    """Return the mean ΔE00 (L,) of surfaces under lights in place of the lamps."""
    surfaces = on_grid(read_atlas(atlas), observer.grid())
    radiometry = uplift.load_emission().data.radiometry
    return relit_delta_e(known_lamps().power, power, surfaces, radiometry).mean(axis=1)


def errors() -> Iterator[Row]:
    """Yield the errors of lamps that methods do not know."""
    lamps = known_lamps()
    radiometry = uplift.load_emission().data.radiometry
    unknown = unknown_lamps(lamps)
    checker = on_grid(read_atlas("macbeth"), observer.grid())
    uv = chromaticity(lamps.power @ radiometry)
    d65 = lamps.power[lamps.names.index("D65")]
    lights = {}
    for rule, mask in unknown.items():
        table = {TABLE: predicted(rule)[0]}
        lights[rule] = table | by_nearest(lamps, mask, radiometry)
    lights[LAMP] |= {
        "the prior alone": fit_lamp_prior(lamps.power, checker, radiometry)[1],
        "sigmoid × D65": sigmoid_times_d65(lamps.power, d65),
        "Planck, moved": planck(uv, radiometry),
    }
    for (rule, methods), (name, atlas) in product(lights.items(), SURFACES.items()):
        for method, power in methods.items():
            delta_e = relit(power, atlas)
            place = {"rule": rule, "method": method, "set": name}
            yield {**place, "median": np.median(delta_e), **summary(delta_e)}


def calibration() -> Iterator[Row]:
    """Yield expected and measured errors of thirds of the lamps, by expected errors."""
    power, expected = predicted(LAMP)
    measured = relit(power, "macbeth")
    for third in np.array_split(np.argsort(expected, kind="stable"), 3):
        yield {"expected": expected[third].mean(), "measured": measured[third].mean()}


def exact_lamps() -> int:
    """Return the number of lamps that the shipped table has exactly."""
    return len(uplift.load_emission().lamp_names)


QUESTIONS = {"errors": errors, "calibration": calibration, "exact": exact_lamps}
