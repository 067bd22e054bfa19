"""Round trips, ranges, orders of growth and solvers of cubes, for docs/accuracy.md."""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product, starmap
from typing import Any
from unittest import mock

import numpy as np
from scipy.optimize import differential_evolution

import uplift
from benchmarks import DOCS, MACBETH, Row, record
from benchmarks.materials import errors, materials
from uplift.atlas import on_grid
from uplift.colorimetry import Sensor, delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras.images.exr import blue_slices
from uplift.extras.pages.figure import colour_map, new_figure, show_image, write_figure
from uplift.extras.pages.sheet import mosaic
from uplift.fit import Problem, shells
from uplift.lab.method import at_1_nm, published_srgb
from uplift.lab.timing import time_calls
from uplift.lattice import Status
from uplift.lookup import MODES, Cube
from uplift.models import reflectance

RANGES = (
    (380, 780, 10),
    (380, 780, 5),
    (380, 780, 1),
    (360, 830, 10),
    (360, 830, 5),
    (360, 830, 1),
    (360, 1000, 5),
)
"""First and last wavelength and step in nm."""
VISIBLE = np.arange(400, 701, 5)
DIMS = (16, 32, 64)
QUERIES = np.random.default_rng(20000).random((20000, 3))
ON_FACES = np.where(np.abs(QUERIES - 0.5) > 0.4, np.round(QUERIES), QUERIES)
"""The same colours, those near faces, edges and corners of the lattice on them."""
STARTS = 256
"""Colours from which the largest error is searched."""
ORDER_DIM = 32
SOLVER_DIM = 16
RUNS = 3
SPACES = ("sRGB", "ITU-R BT.2020", "ProPhoto RGB")
ORDERS = ("outward", "coarse-to-fine", "neighbours")
OTHERS = ("rawtoaces", "cie2017")
"""Materials that a cube of the ColorChecker answers for."""
SOLVERS = ("least-change", "gauss-newton", "dogleg", "levenberg-marquardt")


def main() -> None:
    """Measure and store."""
    measure_round_trips()
    draw_rounds()
    measure_growth()


def measure_round_trips() -> None:
    """Measure what cubes return for a colour, by their model, dim and range."""
    fitted = []
    round_trips = []
    for name, cube in cubes():
        fitted.append({"cube": name, **fit_quality(cube)})
        sensor = cube.data.sensor
        fine = at_1_nm(sensor)
        round_trips.append(
            {
                "cube": name,
                "errors": {mode: round_trip(cube, sensor, mode) for mode in MODES},
                "fine": {mode: round_trip(cube, fine, mode) for mode in MODES},
                "published": round_trip(cube, published_srgb()),
            }
        )
    record(
        "accuracy",
        queries=len(QUERIES),
        fitted=fitted,
        round_trips=round_trips,
        ranges=starmap(at_range, RANGES),
    )


def measure_growth() -> None:
    """Measure orders of growth and solvers."""
    record(
        "accuracy",
        "growth",
        runs=RUNS,
        orders=starmap(growth, product(SPACES, ORDERS)),
        solvers=map(solver, SOLVERS),
        order_dim=ORDER_DIM,
        solver_dim=SOLVER_DIM,
        materials=[
            {"name": name, "count": len(materials(name).rgb)} for name in OTHERS
        ],
    )


def cubes() -> Iterator[tuple[str, Cube]]:
    """Build the cubes, with their names."""
    build = partial(uplift.build, debug=True)
    for dim, model, atlas in product(DIMS, ("moments", "sigmoid"), (MACBETH, None)):
        name = f"{model}, {'Macbeth' if atlas else 'no atlas'}, {dim}³"
        yield name, build(atlas, dim=dim, model=model)
    for count in (3, 17):
        name = f"{count} coefficients, Macbeth, 32³"
        yield name, build(MACBETH, dim=32, coefficients=count)


def fit_quality(cube: Cube) -> Row:
    """Return the rounds of growth, counts of nodes and the largest residual."""
    points = cube.data.points
    counts = points.counts()
    return {
        "rounds": points.round.max() + 1,
        "improved": counts["improved"],
        "unfitted": counts["unfitted"],
        "worst": points.distance.max(),
    }


def round_trip(cube: Cube, sensor: Sensor, mode: str = "spectra") -> list[float]:
    """Return the mean and largest ΔE00 between colours and those of their spectra."""

    def error(rgb: Array) -> Array:
        spectra = cube.reflectance(rgb, sensor.wavelengths, mode)
        return delta_e_rgb(sensor, rgb, sensor.rgb(spectra))

    worst = largest(error, np.concatenate([QUERIES, ON_FACES]))
    return [error(QUERIES).mean(), worst]


def largest(error: Callable[[Array], Array], rgb: Array) -> float:
    """Search the largest error, from the worst of colours (n, 3) on."""
    worst = rgb[np.argsort(error(rgb))[-STARTS:]]
    search = differential_evolution(
        lambda rgb: -error(rgb.T),
        [(0, 1)] * 3,
        strategy="rand1bin",
        init=worst,
        rng=1,
        polish=False,
        vectorized=True,
        updating="deferred",
    )
    return -search.fun


def at_range(shortest: int, longest: int, step: int) -> Row:
    """Build the ColorChecker at a range; return errors at 1 nm, and of its entries."""
    cube = uplift.build(MACBETH, shortest=shortest, longest=longest, step=step)
    atlas = uplift.read_atlas(MACBETH)
    rows = [atlas.names.index(name) for name in cube.data.atlas.names]
    measured = on_grid(atlas, VISIBLE)[rows]
    difference = cube.reflectance(cube.data.atlas.rgb, VISIBLE) - measured
    return {
        "range": f"{shortest}–{longest} nm",
        "step": step,
        "fine": round_trip(cube, at_1_nm(cube.data.sensor)),
        "rms": np.sqrt((difference**2).mean()),
    }


def draw_rounds() -> None:
    """Draw the round of each node of the ColorChecker, a tile for each blue."""
    data = uplift.build(MACBETH, dim=ORDER_DIM, debug=True).data
    rounds = mosaic(blue_slices(data.points.round.astype(float), ORDER_DIM))
    figure = new_figure(7.2, 6.0)
    axes = figure.subplots()
    drawn = show_image(axes, rounds, cmap=colour_map(), interpolation="nearest")
    bar = figure.colorbar(drawn, ax=axes, fraction=0.04, pad=0.02, label="round")
    bar.outline.set_visible(False)
    write_figure(figure, DOCS / "accuracy" / "rounds.png", force=True)


def growth(space: str, order: str) -> Row:
    """Build in an order of growth, and compare answers for unknown materials."""
    build = partial(
        uplift.build,
        MACBETH,
        dim=ORDER_DIM,
        growth=order,
        space=space,
        leave_out=OTHERS,
        debug=True,
    )
    cube = build()
    _, seconds = time_calls(build, RUNS)
    answers = {}
    if space == SPACES[0]:
        for name in OTHERS:
            queried = materials(name)
            answers[name] = errors(cube.reflectance(queried.rgb), queried)
    status = cube.data.points.status
    return {
        "growth": order,
        "space": space,
        "seconds": seconds,
        "rounds": fit_quality(cube)["rounds"],
        "outward": share_outward(cube),
        "unfitted": (status == Status.UNFITTED).sum(),
        "unrealisable": (status == Status.UNREALISABLE).sum(),
        "answers": answers,
    }


def share_outward(cube: Cube) -> float:
    """Return the share of nodes whose round is their distance from the nearest seed, in
    steps to 26 neighbours.
    """
    points = cube.data.points
    is_seed = np.isin(points.status, (Status.ATLAS_PRIMARY, Status.ATLAS_CORNER))
    distance, _ = shells(cube.data.lattice, np.flatnonzero(is_seed))
    fitted = points.round >= 0
    return (points.round == distance)[fitted].mean()


def solver(name: str) -> Row:
    """Build a small cube with a solver, and compare it with the default."""
    build = partial(uplift.build, MACBETH, dim=SOLVER_DIM)
    default = build()
    build = partial(build, solver=name)
    _, first = time_calls(build, 1)
    cube = build()
    _, seconds = time_calls(build, RUNS)
    improvements = cube.data.provenance["improvements"]
    difference = np.abs(node_spectra(cube) - node_spectra(default)).max(axis=1)
    inner = ~np.isin(cube.data.lattice.points, (0, 1)).any(axis=1)
    return {
        "solver": name,
        "first": first.median,
        "seconds": seconds,
        "steps": steps_per_node(build),
        "before": improvements[0]["tried"] if improvements else 0,
        "unfitted": cube.data.points.counts()["unfitted"],
        "inner": difference[inner].max(),
        "faces": difference[~inner].max(),
    }


def steps_per_node(build: Callable[[], Cube]) -> float:
    """Return the mean steps of a node's batches."""
    solve = Problem.solve
    steps = []

    def counted(*args: Any) -> Any:
        solution = solve(*args)
        steps.append(solution.steps.sum())
        return solution

    with mock.patch.object(Problem, "solve", counted):
        size = build().data.lattice.size
    return sum(steps) / size


def node_spectra(cube: Cube) -> Array:
    """Return the reflectances (n, N) of the nodes."""
    return reflectance(
        cube.data.model, cube.data.points.coefficients, cube.data.sensor.wavelengths
    )
