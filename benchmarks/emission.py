"""Emission tables: lamps left out, exactness, expected errors and cost, for
docs/guides/lights.md.
"""

import re
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import product

import numpy as np

import uplift
from benchmarks import Row, record
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer as observers
from uplift.colorimetry.illuminants import black_body
from uplift.common.arrays import Array, Mask
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.fit import nearest_lights
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity, unit_xyz
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.emission.prior import fit_lamp_prior, relit_delta_e
from uplift.fit.solver import solve
from uplift.lab.timing import time_calls
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
SAME_COLOURS = 0.5
"""Mean ΔE00 of the relit ColorChecker up to which two lamps are near-duplicates."""
SURFACES = {"ColorChecker": "macbeth", "CIE 2017": "cie2017"}
TABLE = "emission table"
DIRECTIONS = 720
STEPS = 101
COLOURS = 200_000
RUNS = 15
NEAREST = 8


def main() -> None:
    """Measure and store."""
    table = uplift.load_emission()
    lamps = known_lamps()
    surfaces = {
        label: on_grid(read_atlas(name), observers.grid())
        for label, name in SURFACES.items()
    }
    radiometry = table.data.radiometry
    checker = surfaces["ColorChecker"]
    uv = chromaticity(lamps.power @ radiometry)
    unknown = unknown_lamps(lamps, checker, radiometry)
    predictions = predict(lamps, unknown)
    lights = {
        rule: {TABLE: power, **by_nearest(lamps, unknown[rule], radiometry)}
        for rule, (power, _) in predictions.items()
    }
    d65 = lamps.power[lamps.names.index("D65")]
    lights["lamp"] |= {
        "the prior alone": fit_lamp_prior(lamps.power, checker, radiometry)[1],
        "sigmoid × D65": sigmoid_times_d65(lamps.power, table, d65),
        "Planck, moved": planck(uv, radiometry, table.wavelengths),
    }
    power, expected = predictions["lamp"]
    errors = relit_delta_e(lamps.power, power, checker, radiometry).mean(axis=1)
    record(
        "emission",
        lamps=len(lamps),
        exact=len(table.lamp_names),
        rows=summaries(lamps, lights, surfaces, radiometry),
        worst=[
            {"lamp": lamps.names[row], "error": errors[row]}
            for row in np.argsort(errors)[::-1][:8]
        ],
        calibration=[
            {"expected": expected[third].mean(), "measured": errors[third].mean()}
            for third in np.array_split(np.argsort(expected, kind="stable"), 3)
        ],
        exactness=exactness(table, spokes(table, DIRECTIONS, STEPS)),
        lookups=lookups(),
    )


def lamp_family(name: str) -> str:
    """Return the family of a lamp. Raises `ValueError` unless it is in one."""
    (family,) = [
        family for family, pattern in FAMILIES.items() if re.fullmatch(pattern, name)
    ]
    return family


def unknown_lamps(
    lamps: Lamps, reflectances: Array, radiometry: Array
) -> dict[str, Mask]:
    """Return which lamps (L, L) the prediction of each lamp must not know, by rule.

    Shapes: ``reflectances`` (P, N), ``radiometry`` (N, 3).
    """
    families = np.array([lamp_family(name) for name in lamps.names])
    differences = []
    for row in lamps.power:
        same = np.broadcast_to(row, lamps.power.shape)
        delta_e = relit_delta_e(lamps.power, same, reflectances, radiometry)
        differences.append(delta_e.mean(axis=1))
    apart = np.array(differences)
    return {
        "lamp": np.eye(len(lamps), dtype=bool),
        "near-duplicates": (apart <= SAME_COLOURS) | (apart.T <= SAME_COLOURS),
        "family": families[:, None] == families,
    }


def predict(
    lamps: Lamps, unknown: Mapping[str, Mask], **size: int
) -> dict[str, tuple[Array, Array]]:
    """Predict lamps by tables built without those that a prediction must not know (L,
    L).

    Returns power (L, N) and expected errors (L,) by rule.
    """
    shape = (len(unknown), len(lamps))
    power = np.empty((*shape, lamps.power.shape[1]))
    expected = np.empty(shape)
    masks = np.concatenate([*unknown.values()])
    sets, member = np.unique(masks, axis=0, return_inverse=True)
    for number, left_out in enumerate(sets):
        names = [lamps.names[row] for row in np.flatnonzero(left_out)]
        table = uplift.build_emission(without=names, **size)
        rule, rows = np.nonzero(member.reshape(shape) == number)
        rgb = table.rgb(lamps.power[rows])
        power[rule, rows] = table.spectrum(rgb)
        expected[rule, rows] = table.expected_error(rgb)
    return dict(zip(unknown, zip(power, expected, strict=True), strict=True))


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


def sigmoid_times_d65(power: Array, table: EmissionTable, d65: Array) -> Array:
    """Return lights with the RGB of others (n, N) as pbrt-v4 makes them.

    RGB is divided by twice its largest component; a sigmoid reflectance has that colour
    under D65 (N,).

    Pharr, Jakob & Humphreys 2023, "Physically based rendering", 4th edition, section
    4.6.6, RGBIlluminantSpectrum. Jakob & Hanika 2019, eq. 5.
    """
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


MIREDS = np.linspace(20, 1000, 981)
"""Reciprocal temperatures in 1/MK of the Planckian radiators that are compared."""


def planck(uv: Array, radiometry: Array, wavelengths: Array) -> Array:
    """Return the Planckian radiators of the correlated colour temperatures, moved to
    the chromaticities (n, 2).

    CIE 015:2018, 9.5: the correlated colour temperature, by the distance in CIE 1960
    uv.
    """
    radiators = np.stack([black_body(1e6 / mired, wavelengths) for mired in MIREDS])
    apart = (uv[:, None] - chromaticity(radiators @ radiometry)) * (1.0, 2 / 3)
    nearest = radiators[np.linalg.norm(apart, axis=-1).argmin(axis=1)]
    return nearest_lights(nearest, uv, radiometry)


def summaries(
    lamps: Lamps,
    lights: dict[str, dict[str, Array]],
    surfaces: dict[str, Array],
    radiometry: Array,
) -> Iterator[Row]:
    """Yield mean, median and 95th percentile over the lamps of the mean ΔE00, by rule,
    method and surfaces.
    """
    for rule, methods in lights.items():
        for method, power in methods.items():
            row = {"rule": rule, "method": method}
            for label, reflectances in surfaces.items():
                delta_e = relit_delta_e(lamps.power, power, reflectances, radiometry)
                errors = delta_e.mean(axis=1)
                median, high = np.percentile(errors, (50, 95))
                row[label] = {"mean": errors.mean(), "median": median, "p95": high}
            yield row


def spokes(table: EmissionTable, directions: int, steps: int) -> Array:
    """Return u′v′ (directions · steps, 2) from white up to the spectral locus."""
    angle = np.arange(directions) * 2 * np.pi / directions
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    locus = direction / table.data.lattice.polar(direction)[2][:, None]
    share = np.linspace(0, 1, steps)[:, None]
    return (table.data.lattice.white + locus[:, None] * share).reshape(-1, 2)


def exactness(table: EmissionTable, uv: Array) -> Iterator[Row]:
    """Yield the largest difference from u′v′ (n, 2) and the smallest power, by type."""
    for dtype in ("float64", "float32"):
        power = table.spectrum_of_xyz(unit_xyz(uv), dtype=dtype)
        xyz = power.astype(float) @ table.data.radiometry
        apart = np.linalg.norm(chromaticity(xyz) - uv, axis=1)
        yield {
            "type": dtype,
            "colours": len(uv),
            "uv_error": apart.max(),
            "min_power": power.min(),
        }


def lookups() -> Iterator[Row]:
    """Yield ns per colour of lights and of reflectances, and their ratio, by type."""
    rgb = np.random.default_rng(1).random((COLOURS, 3))
    table = uplift.load_emission()
    cube = uplift.load()
    grids = (np.linspace(400, 700, 16), table.wavelengths)
    for at, dtype in product(grids, ("float64", "float32")):
        times = []
        for query in (table.spectrum, cube.reflectance):
            call = partial(query, rgb, at, dtype=dtype)
            call()
            times.append(time_calls(call, RUNS)[0].scaled(1e9 / COLOURS))
        light, reflectance = times
        yield {
            "type": dtype,
            "wavelengths": len(at),
            "colours": COLOURS,
            "light": light,
            "reflectance": reflectance,
            "ratio": light.median / reflectance.median,
        }
