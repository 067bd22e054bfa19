"""Emission tables: lamps left out, exactness, expected errors and cost, for docs/emission.md and its picture."""

from __future__ import annotations

import itertools
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import uplift
from benchmarks import DOCS, record
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer as observers
from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_of
from uplift.colorimetry.lights import STANDARD_ILLUMINANTS, Lamps
from uplift.common.arrays import Array
from uplift.fit.solver import solve
from uplift.lab.timing import spread
from uplift.lights.discs import LampEntries
from uplift.lights.fit import nearest_lights, unit_xyz
from uplift.lights.lattice import DENOMINATOR, chromaticity
from uplift.lights.lookup import EmissionTable
from uplift.lights.prior import fit_lamp_prior, relit_delta_e
from uplift.models.minimum_norm import forward_map
from uplift.models.sigmoid import Sigmoid
from uplift.viz.figure import GREY, INK, new_figure, rendered, write_png
from uplift.viz.scatter import Label, draw_labels

FAMILIES = {
    "daylight": r"[BC]|I?D\d\d",
    "tungsten": r"A|.*Incandescent",
    "equal energy": r"E",
    "xenon": r"Kinoton.*",
    "halophosphate": r"FL[1-6]|FL3\.[1-3]|(Cool White|Daylight) FL|F34.*",
    "broadband fluorescent": r"FL[7-9]|FL3\.([4-6]|1[2-5])|F40.*|Natural|Thorn.*",
    "three-band fluorescent": r"FL1[0-2]|FL3\.([7-9]|1[01])|F32.*|Philips TL-84|T8 .*|Triphosphor FL",
    "discharge": r"HP\d|.*HPS\)?|LPS|Mercury|H38.*|MHC.*|Metal Halide",
    "phosphor LED": r"LED-(B|BH|V)\d|PHOS-\d|Phosphor LED.*|Luxeon.*",
    "LED mixture": r"LED-RGB1|[34]-LED.*",
}
"""Patterns of the names of colour-science, by the technology of the lamp."""
SAME_COLOURS = 0.5
"""Mean ΔE00 of the relit ColorChecker up to which two lamps are near-duplicates."""


@dataclass(frozen=True, eq=False)
class Predictions:
    """Power (n, N) of lights by tables with the discs of other lamps and without any, and expected errors (n,)."""

    table: Array
    without_discs: Array
    expected: Array


def lamp_family(name: str) -> str:
    """Return the family of a lamp. Raises `LookupError`."""
    found = [key for key, pattern in FAMILIES.items() if re.fullmatch(pattern, name)]
    if len(found) != 1:
        raise LookupError(f"families of lamp '{name}': {found}")
    return found[0]


def unknown_lamps(lamps: Lamps, reflectances: Array, radiometry: Array) -> dict[str, NDArray[np.bool_]]:
    """Return which lamps (L, L) the prediction of each lamp must not know, by rule.

    Shapes: ``reflectances`` (P, N), ``radiometry`` (N, 3).
    """
    count = len(lamps)
    families = np.array([lamp_family(name) for name in lamps.names])
    apart = np.array(
        [
            relit_delta_e(lamps.power, np.tile(row, (count, 1)), reflectances, radiometry).mean(axis=1)
            for row in lamps.power
        ]
    )
    return {
        "lamp": np.eye(count, dtype=bool),
        "near-duplicates": (apart <= SAME_COLOURS) | (apart.T <= SAME_COLOURS),
        "family": families[:, None] == families,
    }


def predict(names: tuple[str, ...], unknown: NDArray[np.bool_], power: Array, **size: int) -> Predictions:
    """Predict lights by tables that are built without the lamps that each must not know.

    Shapes: ``unknown`` (n, L), ``power`` (n, N).
    """
    table, without_discs, expected = np.empty_like(power), np.empty_like(power), np.empty(len(power))
    for left_out, rows in left_out_groups(unknown):
        built = uplift.build_emission(without=[names[row] for row in left_out], **size)
        rgb = built.rgb(power[rows])
        table[rows], without_discs[rows] = built.spectrum(rgb), drop_discs(built).spectrum(rgb)
        expected[rows] = built.expected_error(rgb)
    return Predictions(table, without_discs, expected)


def left_out_groups(unknown: NDArray[np.bool_]) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield each set of lamps to leave out, and the lamps that it predicts."""
    sets, member = np.unique(unknown, axis=0, return_inverse=True)
    for number, left_out in enumerate(sets):
        yield np.flatnonzero(left_out), np.flatnonzero(member == number)


def drop_discs(table: EmissionTable) -> EmissionTable:
    """Remove the exact lamps from a table."""
    entries = table.data.entries
    none = LampEntries((), entries.uv[:0], entries.spectra[:0], entries.radius[:0])
    return EmissionTable(replace(table.data, entries=none))


PBRT_SCALE = 2.0
"""Largest component of RGB relative to that of the colour which the sigmoid of pbrt-v4 has."""
TOLERANCE, MAX_PASSES = 1e-7, 200
MIREDS = np.linspace(20, 1000, 981)
"""Reciprocal temperatures in 1/MK among which the nearest Planckian radiator is looked up."""
SECOND_RADIATION_CONSTANT = 1.438776877e-2
"""c₂ in m K."""
NEAREST = 8


@dataclass(frozen=True, eq=False)
class SigmoidLights:
    """Sigmoids times D65: power (n, N), and the largest difference (n,) of linear RGB at a scale of 0.5."""

    power: Array
    missed: Array


def sigmoid_times_d65(power: Array, radiometry: Array, rgb_from_xyz: Array, d65: Array) -> SigmoidLights:
    """Return lights with the RGB of others as pbrt-v4 makes them.

    RGB is divided by twice its largest component; a sigmoid reflectance has that colour under D65.

    Shapes: ``power`` (n, N), ``radiometry`` (N, 3), ``rgb_from_xyz`` (3, 3), ``d65`` (N,).

    Pharr, Jakob & Humphreys 2023, "Physically based rendering", 4th edition, section 4.6.6, RGBIlluminantSpectrum.
    Jakob & Hanika 2019, eq. 5.
    """
    sensor = rgb_from_xyz @ (radiometry * (d65 / (d65 @ radiometry[:, 1]))[:, None]).T
    rgb = power @ radiometry @ rgb_from_xyz.T
    target = rgb / (PBRT_SCALE * rgb.max(axis=1, keepdims=True))
    model, wavelengths = Sigmoid(0.0, 1.0), np.linspace(0.0, 1.0, len(radiometry))
    found = solve(
        forward_map(model, wavelengths, sensor),
        np.zeros((len(target), model.count)),
        target,
        tolerance=TOLERANCE,
        max_passes=MAX_PASSES,
    )
    return SigmoidLights(model.to_reflectance(found.multipliers @ model.basis(wavelengths).T) * d65, found.distance)


def planck(power: Array, radiometry: Array, wavelengths: Array) -> Array:
    """Return the Planckian radiators of the correlated colour temperatures, moved to the chromaticities.

    Shapes: ``power`` (n, N), ``radiometry`` (N, 3), ``wavelengths`` (N,).

    CIE 015:2018, 9.5: the correlated colour temperature, by the distance in CIE 1960 uv.
    """
    metres = wavelengths * 1e-9
    exponent = SECOND_RADIATION_CONSTANT / metres * MIREDS[:, None] * 1e-6
    radiators = metres**-5 / np.expm1(exponent)
    uv = chromaticity(power @ radiometry)
    to_1960 = np.array([1.0, 2 / 3])
    apart = (uv[:, None] - chromaticity(radiators @ radiometry)) * to_1960
    return nearest_lights(radiators[np.linalg.norm(apart, axis=-1).argmin(axis=1)], uv, radiometry)


def nearest(lamps: Lamps, unknown: NDArray[np.bool_], radiometry: Array, count: int) -> Array:
    """Return the mean power (L, N), at luminance 1, of the nearest known lamps.

    Shapes: ``unknown`` (L, L), ``radiometry`` (N, 3).
    """
    uv = chromaticity(lamps.power @ radiometry)
    apart = np.where(unknown, np.inf, np.linalg.norm(uv[:, None] - uv, axis=-1))
    return np.asarray(lamps.power[np.argsort(apart, axis=1, kind="stable")[:, :count]].mean(axis=1))


TYPES = ("float64", "float32")
GREY_SURFACE = 0.18
"""Reflectance of a grey surface."""


def spokes(table: EmissionTable, directions: int, steps: int) -> Array:
    """Return u′v′ (directions · steps, 2) from white to the spectral locus, both included."""
    angle = np.arange(directions) * 2 * np.pi / directions
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rim = direction / table.data.lattice.polar(direction)[2][:, None]
    share = np.linspace(0, 1, steps)
    return np.asarray((table.data.lattice.white + rim[:, None] * share[:, None]).reshape(-1, 2))


def exactness(table: EmissionTable, uv: Array) -> Iterator[dict[str, Any]]:
    """Yield the largest difference in u′v′ and the smallest power at chromaticities (n, 2), by type."""
    radiometry = _radiometry(table)
    for dtype in TYPES:
        power = table.spectrum_of_xyz(unit_xyz(uv), dtype=dtype)
        apart = np.linalg.norm(chromaticity(power.astype(float) @ radiometry) - uv, axis=1)
        yield {
            "type": dtype,
            "colours": len(uv),
            "uv_error": float(apart.max()),
            "min_power": float(power.min()),
        }


def mixtures(table: EmissionTable) -> dict[str, Any]:
    """Return how far answers are from mixtures of two wavelengths in equal parts: in u′v′, and ΔE00.

    ΔE00 is relative to white of the luminance of the colour.
    """
    radiometry = _radiometry(table)
    visible = radiometry[radiometry @ DENOMINATOR > 0]
    single = visible / (visible @ DENOMINATOR)[:, None]
    first, second = np.triu_indices(len(single))
    xyz = (single[first] + single[second]) / 2
    back = table.spectrum_of_xyz(xyz) @ radiometry
    white = table.xyz(np.ones(3)) * xyz[:, 1:2]
    return {
        "colours": len(xyz),
        "uv_error": float(np.linalg.norm(chromaticity(back) - chromaticity(xyz), axis=1).max()),
        "delta_e": float(delta_e_2000(lab_of(xyz, white), lab_of(back, white)).max()),
    }


def round_trips(table: EmissionTable, levels: tuple[float, ...], count: int) -> Iterator[dict[str, Any]]:
    """Yield the errors of RGB → spectrum → RGB by brightness, relative to white of the luminance of the colour."""
    rng = np.random.default_rng(0)
    for level in levels:
        rgb = level * rng.random((count, 3))
        xyz = table.xyz(rgb)
        white = table.xyz(np.ones(3)) * xyz[:, 1:2]
        row: dict[str, Any] = {"level": level}
        for dtype in TYPES:
            back = table.xyz(table.rgb(table.spectrum(rgb, dtype=dtype)))
            row[dtype] = float(delta_e_2000(lab_of(xyz, white), lab_of(back, white)).max())
        yield row


def white_lights(
    table: EmissionTable, lamps: Lamps, names: tuple[str, ...], reflectances: Array
) -> Iterator[dict[str, Any]]:
    """Yield how far answers at the chromaticities of lamps are from the lamps, and grey surfaces from grey."""
    radiometry = _radiometry(table)
    for name in names:
        lamp = lamps.power[lamps.names.index(name)][None]
        answer = table.spectrum(table.rgb(lamp))
        grey = lab(GREY_SURFACE * answer @ radiometry, lamp @ radiometry)
        yield {
            "lamp": name,
            "spectrum": float(np.abs(answer - lamp).max() / lamp.max()),
            "grey": float(np.hypot(grey[0, 1], grey[0, 2])),
            "checker": float(relit_delta_e(lamp, answer, reflectances, radiometry).mean()),
        }
    white = table.spectrum(np.ones((1, 3)))
    d65 = lamps.power[lamps.names.index("D65")][None]
    grey_rgb = table.rgb(GREY_SURFACE * white)[0]
    yield {
        "lamp": "RGB (1, 1, 1), to D65",
        "spectrum": float(np.abs(white - d65).max() / d65.max()),
        "grey": float(np.ptp(grey_rgb)),
        "checker": float(relit_delta_e(d65, white, reflectances, radiometry).mean()),
    }


def _radiometry(table: EmissionTable) -> Array:
    return np.asarray(table.data.cmfs / table.data.cmfs[:, 1].sum())


WAVELENGTHS = (np.linspace(400, 700, 16), None)
"""Wavelengths of lookups: few, and those of the tables."""


def lookups(count: int, runs: int) -> Iterator[dict[str, Any]]:
    """Yield nanoseconds per colour of lights and of reflectances, in turn, and their ratio, by type.

    The order changes from run to run, and the ratio is that of the times of one run.
    """
    rgb = np.random.default_rng(1).random((count, 3))
    table, cube = uplift.load_emission(), uplift.load()
    for at, dtype in itertools.product(WAVELENGTHS, ("float64", "float32")):
        queries = {
            "light": partial(table.spectrum, rgb, at, dtype=dtype),
            "reflectance": partial(cube.reflectance, rgb, at, dtype=dtype),
        }
        for query in queries.values():
            query()
        found: dict[str, list[float]] = {what: [] for what in queries}
        for run in range(runs):
            for what in sorted(queries, reverse=bool(run % 2)):
                begin = time.perf_counter()
                queries[what]()
                found[what].append((time.perf_counter() - begin) * 1e9 / count)
        yield {
            "type": dtype,
            "wavelengths": len(table.wavelengths if at is None else at),
            "colours": count,
            **{what: spread(times) for what, times in found.items()},
            "ratio": spread([light / other for light, other in zip(*found.values(), strict=True)]),
        }


SIZE = 320
"""Points of the map along u′."""
WIDTH, HEIGHT = 0.65, 0.62
"""Range of u′ and v′."""
MARGIN = 0.03
"""Distance in u′v′ around the lamps that the second panel shows."""
LABELLED = 8
"""Lamps with the largest errors, which are named."""


def draw_error_map(table: EmissionTable, names: tuple[str, ...], power: Array, errors: Array, path: Path) -> None:
    """Write the picture. Shapes: ``power`` (L, N), ``errors`` (L,)."""
    expected, uv = expected_errors(table), chromaticity(power @ table.data.cmfs)
    limit = float(np.nanmax(expected))
    figure = new_figure(11, 5.4)
    left, right = figure.subplots(1, 2)
    shown = left.imshow(expected, origin="lower", extent=(0, WIDTH, 0, HEIGHT), cmap="viridis", vmin=0, vmax=limit)
    left.plot(*uv.T, ".", color="white", markersize=2.5)
    left.set_title("expected by the table; points are its lamps")
    right.scatter(*uv.T, c=errors, s=16, cmap="viridis", vmin=0, vmax=limit, edgecolors=INK, linewidths=0.3)
    right.set_title("measured: each lamp left out")
    for axes in (left, right):
        _diagram(axes, table)
    low, high = uv.min(axis=0) - MARGIN, uv.max(axis=0) + MARGIN
    right.set_xlim(low[0], high[0])
    right.set_ylim(low[1], high[1])
    bar = figure.colorbar(shown, ax=[left, right], shrink=0.85, extend="max")
    bar.set_label("mean ΔE00 of the ColorChecker")
    rendered(figure)  # the layout decides where labels have room
    figure.set_layout_engine("none")
    largest = np.argsort(errors)[::-1][:LABELLED]
    labels = [Label(names[row], (uv[row, 0], uv[row, 1]), INK, bold=False, gid="") for row in largest]
    draw_labels(right, labels, uv, np.empty((0, 2)))
    write_png(figure, path, force=True)


def expected_errors(table: EmissionTable, size: int = SIZE) -> Array:
    """Return the expected errors over u′v′, row by row from v′ = 0; NaN where no light is."""
    u = (np.arange(size) + 0.5) / size * WIDTH
    v = (np.arange(round(size * HEIGHT / WIDTH)) + 0.5) / size * WIDTH
    uv = np.stack(np.meshgrid(u, v), axis=-1)
    flat = uv.reshape(-1, 2)
    inside = table.data.lattice.contains(flat)
    found = np.full(len(flat), np.nan)
    xyz = unit_xyz(flat[inside])
    found[inside] = table.expected_error(table.rgb_of_xyz(xyz))
    return found.reshape(uv.shape[:2])


def _diagram(axes: Any, table: EmissionTable) -> None:
    """Draw the spectral locus and the triangle of the space."""
    knots = table.data.lattice.knots
    axes.plot(*np.concatenate([knots, knots[:1]]).T, color=INK, linewidth=0.8)
    corners = chromaticity(table.rgb_to_xyz.T)
    axes.plot(*np.concatenate([corners, corners[:1]]).T, color=GREY, linewidth=0.7, linestyle="--")
    axes.set_aspect("equal")
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, HEIGHT)
    axes.set_xlabel("u′")
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_ylabel("v′")


SURFACES = {"ColorChecker": "macbeth", "CIE 2017": "cie2017"}
TABLE, ALONE = "emission table", "the prior alone"
DIRECTIONS, STEPS = 720, 101
LEVELS = (1e-3, 1.0, 1e3, 1e5)
COLOURS, LOOKUP_RUNS = 200_000, 15
THIRDS = 3
PICTURE = DOCS / "emission" / "errors.png"


def main() -> None:
    """Measure, draw and store."""
    table, lamps = uplift.load_emission(), observers.lamps()
    surfaces = {label: on_grid(read_atlas(name), observers.grid()) for label, name in SURFACES.items()}
    radiometry = table.data.cmfs / table.data.cmfs[:, 1].sum()
    checker = surfaces["ColorChecker"]
    unknown = unknown_lamps(lamps, checker, radiometry)
    rules, repeated = np.concatenate(list(unknown.values())), np.tile(lamps.power, (len(unknown), 1))
    found = predict(lamps.names, rules, repeated)
    estimates = {
        rule: {TABLE: power, f"{TABLE}, no exact lamps": plain, **others(lamps, unknown[rule], radiometry)}
        for rule, power, plain in zip(
            unknown,
            np.split(found.table, len(unknown)),
            np.split(found.without_discs, len(unknown)),
            strict=True,
        )
    }
    estimates["lamp"] |= independent(table, lamps, checker)
    errors = relit_delta_e(lamps.power, estimates["lamp"][TABLE], checker, radiometry).mean(axis=1)
    PICTURE.parent.mkdir(exist_ok=True)
    draw_error_map(table, lamps.names, lamps.power, errors, PICTURE)
    record(
        "emission",
        lamps=len(lamps),
        exact=len(table.lamp_names),
        space=table.space,
        shape=table.data.lattice.shape,
        prior=table.data.provenance["prior"],
        same_colours=SAME_COLOURS,
        left_out={rule: float(rows.sum(axis=1).mean()) for rule, rows in unknown.items()},
        families=len({lamp_family(name) for name in lamps.names}),
        rows=list(rows(lamps, estimates, surfaces, radiometry)),
        worst=worst(lamps, estimates["lamp"][TABLE], errors, table),
        calibration=list(calibration(np.split(found.expected, len(unknown))[0], errors)),
        exactness=list(exactness(table, spokes(table, DIRECTIONS, STEPS))),
        mixtures=mixtures(table),
        round_trips=list(round_trips(table, LEVELS, COLOURS // 10)),
        white=list(white_lights(table, lamps, STANDARD_ILLUMINANTS, checker)),
        lookups=list(lookups(COLOURS, LOOKUP_RUNS)),
    )


def others(lamps: Lamps, unknown: NDArray[np.bool_], radiometry: Array) -> dict[str, Array]:
    """Return the lights (L, N) by methods that use other lamps."""
    uv = chromaticity(lamps.power @ radiometry)
    found = {}
    for label, count in {"nearest lamp": 1, f"mean of the {NEAREST} nearest": NEAREST}.items():
        power = nearest(lamps, unknown, radiometry, count)
        found |= {label: power, f"{label}, moved": nearest_lights(power, uv, radiometry)}
    return found


def independent(table: EmissionTable, lamps: Lamps, checker: Array) -> dict[str, Array]:
    """Return the lights (L, N) of the prior alone, and by methods that need no measured lamps but D65."""
    radiometry = table.data.cmfs / table.data.cmfs[:, 1].sum()
    sigmoid = sigmoid_times_d65(
        lamps.power, radiometry, np.linalg.inv(table.rgb_to_xyz), lamps.power[lamps.names.index("D65")]
    )
    return {
        ALONE: fit_lamp_prior(lamps.power, checker, radiometry)[1],
        "sigmoid × D65": sigmoid.power,
        "Planck, moved": planck(lamps.power, radiometry, table.wavelengths),
    }


def rows(
    lamps: Lamps,
    estimates: dict[str, dict[str, Array]],
    surfaces: dict[str, Array],
    radiometry: Array,
) -> Iterator[dict[str, Any]]:
    """Yield mean, median and 95th percentile over the lamps of the mean ΔE00, by rule, method and surfaces."""
    for rule, methods in estimates.items():
        for method, power in methods.items():
            row: dict[str, Any] = {"rule": rule, "method": method}
            for label, reflectances in surfaces.items():
                errors = relit_delta_e(lamps.power, power, reflectances, radiometry).mean(axis=1)
                row[label] = {
                    "mean": float(errors.mean()),
                    "median": float(np.median(errors)),
                    "p95": float(np.percentile(errors, 95)),
                }
            yield row


def worst(lamps: Lamps, power: Array, errors: Array, table: EmissionTable, count: int = 8) -> list[dict[str, Any]]:
    """Return the lamps with the largest errors, and how far answers are from their chromaticity."""
    radiometry = table.data.cmfs
    missed = chromaticity(power @ radiometry) - chromaticity(lamps.power @ radiometry)
    return [
        {
            "lamp": lamps.names[row],
            "error": float(errors[row]),
            "uv_error": float(np.linalg.norm(missed[row])),
        }
        for row in np.argsort(errors)[: -count - 1 : -1]
    ]


def calibration(expected: Array, errors: Array) -> Iterator[dict[str, float]]:
    """Yield the mean expected and measured errors of thirds of the lamps, by expected error."""
    for part in np.array_split(np.argsort(expected, kind="stable"), THIRDS):
        yield {"expected": float(expected[part].mean()), "measured": float(errors[part].mean())}


if __name__ == "__main__":
    main()
