"""Spectra from photographs under several lights, for docs/guides/two-lights.md."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import chain, product

import numpy as np

from benchmarks import Row, record, six_numbers
from benchmarks.materials import (
    FETCHED,
    SENSOR,
    SHIPPED,
    Materials,
    materials,
    other_halves,
)
from benchmarks.two_lights_picture import draw_pictures
from benchmarks.two_lights_texture import texture_cost
from uplift.colorimetry import Light, observer
from uplift.common.arrays import Array
from uplift.extras.photographs import Noise, Photographs, photograph, prepare
from uplift.extras.photographs.errors import photographed
from uplift.extras.report.measures import delta_e_under
from uplift.lab.timing import time_calls
from uplift.lookup import Cube
from uplift.lookup.errors_under_lights import Evidence, errors_from, evidence

DIM = 32
SETS = (*SHIPPED, *FETCHED)
CHART = "macbeth"
CHART_LIKE = ("macbeth", "babelcolor")
"""Sets that are measurements of the chart: its matrix knows their patches."""
LIGHTS = ("A", "FL2", "FL11", "LED-B3", "LED-RGB1", "HP1")
FURTHER = (("A",), ("LED-B3",), ("A", "FL11"))
"""Lights of the photographs next to that under D65."""
SHARES = (0.0, 0.002, 0.005, 0.01, 0.02)
"""Standard deviations of the noise, as shares of each value."""
SHOWN_SHARES = (0.0, 0.005, 0.02)
"""Shares of the first table."""
FLOOR = 0.1
"""Floor of the noise, relative to its share."""
CUBE = "one photograph"
OURS = "photographs"
FORMULA = "formula of 81 samples"
PCA = "principal components"
CHART_MATRIX = "chart matrix"
METHODS = (CUBE, OURS, FORMULA, PCA, CHART_MATRIX)
TOGETHER = "all but the chart"
"""All shipped sets but measurements of the chart."""
OTHERS = tuple(name for name in SHIPPED if name not in CHART_LIKE)
QUANTILE = 0.95
SPEED_COLOURS = 1 << 17
SPEED_RUNS = 12


def main() -> None:
    """Measure and store."""
    results = {name: of_set(name) for name in SETS}
    results[TOGETHER] = together([results[name] for name in OTHERS])
    rows = list(chain.from_iterable(map(as_rows, results, results.values())))
    record(
        "two-lights",
        dim=DIM,
        lights=list(LIGHTS),
        shares=list(SHARES),
        shown_shares=list(SHOWN_SHARES),
        floor=FLOOR,
        chart=CHART,
        chart_like=list(CHART_LIKE),
        methods=list(METHODS),
        together=TOGETHER,
        sets=[{"set": name, "spectra": len(materials(name).rgb)} for name in SETS],
        rows=rows,
        overview=overview(rows),
        compared=compared(rows),
        coverage=coverage(rows),
        claims=claims(rows),
        scene=draw_pictures(),
        speed=speed(),
        texture=texture_cost(),
    )


@dataclass(frozen=True)
class Case:
    """Further lights of photographs, and the share of their noise."""

    further: tuple[str, ...]
    share: float

    @property
    def noise(self) -> Noise:
        """Return the noise of all photographs."""
        return Noise(self.share, FLOOR * self.share)

    @property
    def unseen(self) -> tuple[str, ...]:
        """Return the lights that no photograph has."""
        return tuple(name for name in LIGHTS if name not in self.further)


CASES = [Case(further, share) for further, share in product(FURTHER, SHARES)]


@dataclass(frozen=True, eq=False)
class Result:
    """ΔE00 (n, U) of each method under the unseen lights, and which (n, U, 2) of the
    photographs' errors lie within the stated ones.
    """

    errors: dict[str, Array]
    within: Array


Results = dict[Case, Result]


@cache
def light(name: str) -> Light:
    """Return a light by its name."""
    return observer.light(name)


def noisy(values: Array, noise: Noise, random: np.random.Generator) -> Array:
    """Return values of a photograph with noise."""
    scale = np.sqrt(noise.variance(values))
    return values + scale * random.standard_normal(values.shape)


def of_set(name: str) -> Results:
    """Return the results at the unseen halves of a set."""
    parts: dict[Case, list[Result]] = {case: [] for case in CASES}
    for seed, (cube, queried) in enumerate(other_halves(name, dim=DIM)):
        for case in CASES:
            random = np.random.default_rng(seed)
            parts[case].append(of_case(cube, queried, case, random))
    results = {case: joined(case_parts) for case, case_parts in parts.items()}
    if name in CHART_LIKE:
        for result in results.values():
            del result.errors[CHART_MATRIX]
    return results


def of_case(
    cube: Cube, queried: Materials, case: Case, random: np.random.Generator
) -> Result:
    """Photograph materials, and answer the photographs by all methods."""
    further = [photograph(SENSOR, name) for name in case.further]
    photographs = prepare(cube, further, case.noise)
    rgb = np.clip(noisy(queried.rgb, case.noise, random), 0, 1)
    others = noisy(queried.measured @ photographs.matrix.T, case.noise, random)
    answers = spectra_of_all(photographs, rgb, others)
    lights = [light(name) for name in case.unseen]
    errors = {
        method: delta_e_under(lights, spectra, queried.measured)
        for method, spectra in answers.items()
    }
    known = photographed(photographs)
    radii = [errors_from(cube.data, lit, known)(rgb) for lit in lights]
    within = errors[OURS][:, :, None] <= np.stack(radii, axis=1)
    return Result(errors, within)


def spectra_of_all(
    photographs: Photographs, rgb: Array, others: Array
) -> dict[str, Array]:
    """Return the spectra (n, 81) of all methods from linear RGB under all lights."""
    cube = photographs.cube
    noise = photographs.noise
    matrix = np.concatenate([SENSOR.matrix, photographs.matrix])
    numbers = np.concatenate([rgb, others], axis=1)
    variance = noise.variance(numbers)
    left_out = evidence(cube.data)
    known = np.asarray(left_out.measured, dtype=float)
    chart = materials(CHART).measured
    expected = cube.reflectance(rgb)
    return {
        CUBE: expected,
        OURS: photographs.reflectance(rgb, others),
        FORMULA: six_numbers.posterior_mean(
            expected, second_moment(left_out), matrix, variance, numbers
        ),
        PCA: six_numbers.principal_components(
            known, matrix, noise.variance(known @ matrix.T), numbers
        ),
        CHART_MATRIX: six_numbers.chart_matrix(
            chart, matrix, noise.variance(chart @ matrix.T), numbers
        ),
    }


def second_moment(known: Evidence) -> Array:
    """Covariance (81, 81) of the differences of left-out materials."""
    differences = np.asarray(known.measured - known.left_out, dtype=float)
    # A variance of nothing keeps the equations of noiseless numbers solvable.
    least = 1e-12 * np.eye(differences.shape[1])
    return differences.T @ differences / len(differences) + least


def joined(parts: list[Result]) -> Result:
    """Join the results of several halves or sets."""
    errors = {}
    for method in parts[0].errors:
        errors[method] = np.concatenate([part.errors[method] for part in parts])
    return Result(errors, np.concatenate([part.within for part in parts]))


def together(sets: list[Results]) -> Results:
    """Join the results of sets."""
    together = {}
    for case in CASES:
        together[case] = joined([results[case] for results in sets])
    return together


def as_rows(name: str, results: Results) -> Iterator[Row]:
    """Yield a row for each case and method of a set."""
    for case, result in results.items():
        place = {
            "set": name,
            "further": ", ".join(case.further),
            "share": case.share,
        }
        for method, delta_e in result.errors.items():
            row = {**place, "method": method, **summary(case, delta_e)}
            if method == OURS:
                row["standard"] = result.within[..., 0].mean()
                row["bound"] = result.within[..., 1].mean()
            yield row


def summary(case: Case, delta_e: Array) -> Row:
    """Return mean and 95 % of ΔE00 (n, U), over the unseen lights and under each."""
    p95s = np.quantile(delta_e, QUANTILE, axis=0)
    return {
        "mean": delta_e.mean(),
        "p95": np.quantile(delta_e, QUANTILE),
        "means": dict(zip(case.unseen, delta_e.mean(axis=0), strict=True)),
        "p95s": dict(zip(case.unseen, p95s, strict=True)),
    }


def claims(rows: list[Row]) -> Row:
    """Return how the photographs compare with the other methods: ratios of means over
    all sets and cases, cases in which another method is ahead, and unseen lights under
    which one photograph is.
    """
    by_place: dict[tuple[str, str, float], dict[str, Row]] = {}
    for row in rows:
        place = (row["set"], row["further"], row["share"])
        by_place.setdefault(place, {})[row["method"]] = row
    ratios: dict[str, list[float]] = {method: [] for method in METHODS}
    under_lights = []
    ahead = []
    for (name, further, share), methods in by_place.items():
        mean = methods[OURS]["mean"]
        for method, row in methods.items():
            ratios[method].append(mean / row["mean"])
            if row["mean"] < mean:
                place = {"set": name, "further": further, "share": share}
                ahead.append({**place, "method": method, "ratio": mean / row["mean"]})
        of_cube = methods[CUBE]["means"]
        under_lights += [
            value / of_cube[light] for light, value in methods[OURS]["means"].items()
        ]
    return {
        "cases": len(by_place),
        "worst": {method: max(values) for method, values in ratios.items()},
        "mean": {method: np.mean(values) for method, values in ratios.items()},
        "ahead": ahead,
        "lights": len(under_lights),
        "lights_worse": sum(ratio > 1 for ratio in under_lights),
        "light_worst": max(under_lights),
    }


def compared(rows: list[Row]) -> list[Row]:
    """Return mean and 95 % of all methods for `TOGETHER`, a row for each case."""
    lines = []
    for case in CASES:
        further = ", ".join(case.further)
        here = {
            row["method"]: {"mean": row["mean"], "p95": row["p95"]}
            for row in rows
            if (row["set"], row["further"]) == (TOGETHER, further)
            and row["share"] == case.share
        }
        lines.append({"further": further, "share": case.share, "methods": here})
    return lines


def coverage(rows: list[Row]) -> list[Row]:
    """Return the shares of materials within the stated errors by set, with the first of
    `FURTHER` and each of `SHOWN_SHARES`.
    """
    lines = []
    for name in (*SETS, TOGETHER):
        within = [
            {"standard": row["standard"], "bound": row["bound"]}
            for row in rows
            if (row["set"], row["method"]) == (name, OURS)
            and row["further"] == FURTHER[0][0]
            and row["share"] in SHOWN_SHARES
        ]
        lines.append({"set": name, "within": within})
    return lines


def overview(rows: list[Row]) -> list[Row]:
    """Return the means of `TOGETHER` under each light, None where a photograph has it,
    with one photograph and with more.
    """
    lines = []
    for share in SHOWN_SHARES:
        here = [row for row in rows if (row["set"], row["share"]) == (TOGETHER, share)]
        one: Row = {}
        for row in here:
            if row["method"] == CUBE:
                one |= row["means"]
        means = {name: one[name] for name in LIGHTS}
        lines.append({"share": share, "known": "D65", "means": means})
        for row in here:
            if row["method"] == OURS:
                means = {name: row["means"].get(name) for name in LIGHTS}
                known = f"D65, {row['further']}"
                lines.append({"share": share, "known": known, "means": means})
    return lines


def speed() -> Row:
    """Return how many times the CPU time of one photograph two take for a colour. Both
    take turns.
    """
    cube, _ = other_halves("rawtoaces", dim=DIM)[0]
    photographs = prepare(cube, [photograph(SENSOR, "A")])
    rgb = np.random.default_rng(0).random((SPEED_COLOURS, 3))
    others = cube.reflectance(rgb) @ photographs.matrix.T
    photographs.reflectance(rgb[:100], others[:100])
    ratios = []
    for _ in range(SPEED_RUNS):
        _, one = time_calls(lambda: cube.reflectance(rgb), 1)
        _, two = time_calls(lambda: photographs.reflectance(rgb, others), 1)
        ratios.append(two.median / one.median)
    return {"colours": SPEED_COLOURS, "ratio": float(np.median(ratios))}
