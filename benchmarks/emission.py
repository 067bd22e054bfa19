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
THIRDS = 3
WORST = 8


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
    found = predict(lamps, unknown)
    lights = {
        rule: {TABLE: power, **by_nearest(lamps, unknown[rule], radiometry)}
        for rule, (power, _) in found.items()
    }
    lights["lamp"] |= {
        "the prior alone": fit_lamp_prior(lamps.power, checker, radiometry)[1],
        "sigmoid × D65": sigmoid_times_d65(
            lamps.power, table, lamps.power[lamps.names.index("D65")]
        ),
        "Planck, moved": planck(uv, radiometry, table.wavelengths),
    }
    power, expected = found["lamp"]
    errors = relit_delta_e(lamps.power, power, checker, radiometry).mean(axis=1)
    record(
        "emission",
        lamps=len(lamps),
        exact=len(table.lamp_names),
        rows=list(summaries(lamps, lights, surfaces, radiometry)),
        worst=[
            {"lamp": lamps.names[row], "error": errors[row]}
            for row in np.argsort(errors)[::-1][:WORST]
        ],
        calibration=[
            {"expected": expected[part].mean(), "measured": errors[part].mean()}
            for part in np.array_split(np.argsort(expected, kind="stable"), THIRDS)
        ],
        exactness=list(exactness(table, spokes(table, DIRECTIONS, STEPS))),
        lookups=list(lookups(COLOURS, RUNS)),
    )


def lamp_family(name: str) -> str:
    """Return the family of a lamp. Raises `ValueError` unless it is in one."""
    (found,) = [key for key, pattern in FAMILIES.items() if re.fullmatch(pattern, name)]
    return found


def unknown_lamps(
    lamps: Lamps, reflectances: Array, radiometry: Array
) -> dict[str, Mask]:
    """Return which lamps (L, L) the prediction of each lamp must not know, by rule.

    Shapes: ``reflectances`` (P, N), ``radiometry`` (N, 3).
    """
    families = np.array([lamp_family(name) for name in lamps.names])
    same = [np.broadcast_to(row, lamps.power.shape) for row in lamps.power]
    apart = np.array(
        [
            relit_delta_e(lamps.power, row, reflectances, radiometry).mean(axis=1)
            for row in same
        ]
    )
    return {
        "lamp": np.eye(len(lamps), dtype=bool),
        "near-duplicates": (apart <= SAME_COLOURS) | (apart.T <= SAME_COLOURS),
        "family": families[:, None] == families,
    }


def predict(
    lamps: Lamps, unknown: Mapping[str, Mask], **size: int
) -> dict[str, tuple[Array, Array]]:
    """Predict lamps by tables that are built without those that each prediction must
    not know (L, L).

    Returns power (L, N) and expected errors (L,) by rule.
    """
    shape = (len(unknown), len(lamps))
    power = np.empty((*shape, lamps.power.shape[1]))
    expected = np.empty(shape)
    sets, member = np.unique(
        np.stack(list(unknown.values())).reshape(-1, len(lamps)),
        axis=0,
        return_inverse=True,
    )
    for number, left_out in enumerate(sets):
        table = uplift.build_emission(
            without=[lamps.names[row] for row in np.flatnonzero(left_out)], **size
        )
        rule, rows = np.nonzero(member.reshape(shape) == number)
        rgb = table.rgb(lamps.power[rows])
        power[rule, rows], expected[rule, rows] = (
            table.spectrum(rgb),
            table.expected_error(rgb),
        )
    return dict(zip(unknown, zip(power, expected, strict=True), strict=True))


def by_nearest(lamps: Lamps, unknown: Mask, radiometry: Array) -> dict[str, Array]:
    """Return the power (L, N) of the nearest known lamp and the mean of the nearest
    ones, moved to the colours.
    """
    uv = chromaticity(lamps.power @ radiometry)
    apart = np.where(unknown, np.inf, np.linalg.norm(uv[:, None] - uv, axis=-1))
    known = lamps.power[np.argsort(apart, axis=1, kind="stable")[:, :NEAREST]]
    found = {
        "nearest lamp, moved": known[:, 0],
        f"mean of the {NEAREST} nearest, moved": known.mean(axis=1),
    }
    return {
        label: nearest_lights(power, uv, radiometry) for label, power in found.items()
    }


PBRT_SCALE = 2.0
"""Largest component of RGB relative to that of the colour which the sigmoid of pbrt-v4
has.
"""


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
    found = solve(
        forward_map(model, wavelengths, sensor),
        np.zeros((len(rgb), model.count)),
        rgb / (PBRT_SCALE * rgb.max(axis=1, keepdims=True)),
        tolerance=1e-7,
        max_passes=200,
    )
    return np.asarray(
        model.to_reflectance(found.multipliers @ model.basis(wavelengths).T) * d65
    )


MIREDS = np.linspace(20, 1000, 981)
"""Reciprocal temperatures in 1/MK among which the nearest Planckian radiator is looked
up.
"""
SECOND_RADIATION_CONSTANT = 1.438776877e-2
"""c₂ in m K."""


def planck(uv: Array, radiometry: Array, wavelengths: Array) -> Array:
    """Return the Planckian radiators of the correlated colour temperatures, moved to
    the chromaticities (n, 2).

    CIE 015:2018, 9.5: the correlated colour temperature, by the distance in CIE 1960
    uv.
    """
    metres = wavelengths * 1e-9
    radiators = metres**-5 / np.expm1(
        SECOND_RADIATION_CONSTANT / metres * MIREDS[:, None] * 1e-6
    )
    apart = (uv[:, None] - chromaticity(radiators @ radiometry)) * (1.0, 2 / 3)
    return nearest_lights(
        radiators[np.linalg.norm(apart, axis=-1).argmin(axis=1)], uv, radiometry
    )


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
            row: Row = {"rule": rule, "method": method}
            for label, reflectances in surfaces.items():
                errors = relit_delta_e(
                    lamps.power, power, reflectances, radiometry
                ).mean(axis=1)
                median, high = np.percentile(errors, (50, 95))
                row[label] = {"mean": errors.mean(), "median": median, "p95": high}
            yield row


def spokes(table: EmissionTable, directions: int, steps: int) -> Array:
    """Return u′v′ (directions · steps, 2) from white to the spectral locus, both
    included.
    """
    angle = np.arange(directions) * 2 * np.pi / directions
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    locus = direction / table.data.lattice.polar(direction)[2][:, None]
    share = np.linspace(0, 1, steps)[:, None]
    return np.asarray(
        (table.data.lattice.white + locus[:, None] * share).reshape(-1, 2)
    )


def exactness(table: EmissionTable, uv: Array) -> Iterator[Row]:
    """Yield the largest difference in u′v′ and the smallest power at chromaticities (n,
    2), by type.
    """
    for dtype in ("float64", "float32"):
        power = table.spectrum_of_xyz(unit_xyz(uv), dtype=dtype)
        apart = np.linalg.norm(
            chromaticity(power.astype(float) @ table.data.radiometry) - uv, axis=1
        )
        yield {
            "type": dtype,
            "colours": len(uv),
            "uv_error": apart.max(),
            "min_power": power.min(),
        }


def lookups(count: int, runs: int) -> Iterator[Row]:
    """Yield nanoseconds per colour of lights and of reflectances, and the ratio of
    their medians, by type.
    """
    rgb = np.random.default_rng(1).random((count, 3))
    table = uplift.load_emission()
    cube = uplift.load()
    for at, dtype in product(
        (np.linspace(400, 700, 16), table.wavelengths), ("float64", "float32")
    ):
        times = []
        for query in (table.spectrum, cube.reflectance):
            call = partial(query, rgb, at, dtype=dtype)
            call()
            times.append(time_calls(call, runs)[0].scaled(1e9 / count))
        light, reflectance = times
        row = {
            "type": dtype,
            "wavelengths": len(at),
            "colours": count,
            "light": light,
            "reflectance": reflectance,
        }
        yield row | {"ratio": light.median / reflectance.median}
