"""Round trips, ranges, orders of growth and solvers of cubes, for docs/accuracy.md."""

from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import product

import numpy as np
from scipy.optimize import differential_evolution

import uplift
from benchmarks import MACBETH, Row, summary
from benchmarks.timing import time_call
from uplift.atlas.resampling import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb, delta_e_spectra
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.lab.method import at_1_nm, published_srgb
from uplift.lab.study.sensitivity import node_spectra
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import MODES

DIM = 32
MODELS = ("moments", "sigmoid")
COUNTS = (3, 17)
"""Coefficients of further cubes of the ColorChecker."""
DEFAULT = "moments, Macbeth"
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
QUERIES = np.random.default_rng(20000).random((20000, 3))
ON_FACES = np.where(np.abs(QUERIES - 0.5) > 0.4, np.round(QUERIES), QUERIES)
"""The same colours, those near faces, edges and corners of the lattice on them."""
STARTS = 256
"""Colours from which the largest error is searched."""
OPTIONS = (
    ("growth", "outward"),
    ("growth", "coarse-to-fine"),
    ("growth", "neighbours"),
    ("solver", "gauss-newton"),
    ("solver", "dogleg"),
    ("solver", "levenberg-marquardt"),
)
OPTION_DIM = 16
OPTION_LIGHT = "FL11"
RUNS = 3


@cache
def cubes() -> dict[str, Cube]:
    """Return cubes by their names."""
    build = partial(uplift.build, dim=DIM)
    built = {}
    for model, atlas in product(MODELS, (MACBETH, None)):
        name = f"{model}, {'Macbeth' if atlas else 'no atlas'}"
        built[name] = build(atlas, model=model)
    for count in COUNTS:
        built[f"{count} coefficients, Macbeth"] = build(MACBETH, coefficients=count)
    return built


def round_trips() -> Iterator[Row]:
    """Yield what cubes return for a colour by mode, judged with tables at 1 nm, and the
    default cube also with the tables of its fit and with the published matrix.
    """
    for (name, cube), mode in product(cubes().items(), MODES):
        row = {"cube": name, "judge": "1 nm", "mode": mode}
        yield row | round_trip(cube, at_1_nm(cube.data.sensor), mode)
    cube = cubes()[DEFAULT]
    sensors = {"fit": cube.data.sensor, "published": published_srgb()}
    for judge, sensor in sensors.items():
        row = {"cube": DEFAULT, "judge": judge, "mode": "spectra"}
        yield row | round_trip(cube, sensor)


def round_trip(cube: Cube, sensor: Sensor, mode: str = "spectra") -> Row:
    """Return the mean and largest ΔE00 between colours and those of their spectra."""

    def error(rgb: Array) -> Array:
        spectra = cube.reflectance(rgb, sensor.wavelengths, mode)
        return delta_e_rgb(sensor, rgb, sensor.rgb(spectra))

    worst = largest(error, np.concatenate([QUERIES, ON_FACES]))
    return {"mean": error(QUERIES).mean(), "max": worst}


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


def ranges() -> Iterator[Row]:
    """Yield errors at 1 nm, and of the entries, of the ColorChecker by range."""
    atlas = uplift.read_atlas(MACBETH)
    for shortest, longest, step in RANGES:
        cube = uplift.build(MACBETH, shortest=shortest, longest=longest, step=step)
        rows = [atlas.names.index(name) for name in cube.data.atlas.names]
        measured = on_grid(atlas, VISIBLE)[rows]
        difference = cube.reflectance(cube.data.atlas.rgb, VISIBLE) - measured
        yield {
            "range": f"{shortest}–{longest} nm",
            "step": step,
            **round_trip(cube, at_1_nm(cube.data.sensor)),
            "rms": np.sqrt((difference**2).mean()),
        }


def options() -> Iterator[Row]:
    """Yield builds by order of growth and solver, and the ΔE00 between the spectra of
    their nodes and those of the default.
    """
    light = observer.light(OPTION_LIGHT)
    default = node_spectra(uplift.build(MACBETH, dim=OPTION_DIM).data)
    for option, value in OPTIONS:
        build = partial(
            uplift.build, MACBETH, dim=OPTION_DIM, debug=True, **{option: value}
        )
        cube = build()
        points = cube.data.points
        counts = points.counts()
        yield {
            "option": f"--{option} {value}",
            "cpu_s": time_call(build, RUNS).cpu,
            "rounds": points.round.max() + 1,
            "improved": counts["improved"],
            "unfitted": counts["unfitted"],
            **summary(delta_e_spectra(light, default, node_spectra(cube.data))),
        }


QUESTIONS = {"round_trips": round_trips, "ranges": ranges, "options": options}
