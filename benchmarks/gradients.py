"""Traced spectra: an example by gradient descent, precision and rates, for
docs/guides/gradients.md.
"""

from collections.abc import Iterator
from functools import cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

import uplift
from benchmarks import DOCS, Row
from benchmarks.checker import chart, chart_panel
from benchmarks.timing import time_call
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.common.compilation import compiled
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.photographs.photograph import photograph
from uplift.lookup import bulk
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import is_inexact
from uplift.lookup.traceable import TraceableCube, evaluate, traceable

LIGHTS = ("A", "FL11")
FAMILY = "checker"
"""Materials that the prior of the example does not know: other charts."""
DIM = 16
"""Nodes along an axis of the cube of the example."""
STEPS = 50
STEP = 0.15
SHOWN = (0, 2, 5, 10)
"""Steps whose colours are drawn."""
PACKAGED = "packaged"
MACBETH = "macbeth, 32³"
WIDE = "packaged ACEScg"
RATES = {MACBETH: (1_000_000, (3, 16, 31, 81)), WIDE: (20_000, (3, 81))}
"""Colours and wavelengths of the rates. Those of a wide-gamut cube take longer."""
CHECKED = 100_000
"""Colours of the precision."""


@cache
def cubes() -> dict[str, Cube]:
    """Return the cubes of precision and rates."""
    return {
        PACKAGED: uplift.load(),
        MACBETH: uplift.build("macbeth", dim=32),
        WIDE: uplift.load("acescg"),
    }


def loss(
    rgb: jax.Array, traced: TraceableCube, matrix: Any, observed: Any
) -> jax.Array:
    """Squared distance between six numbers of a spectrum and those in photographs."""
    return ((evaluate(traced, rgb) @ matrix.T - observed) ** 2).sum()


@compiled
def descend(traced: TraceableCube, matrix: Any, observed: Any) -> jax.Array:
    """Colours (STEPS + 1, 3) of a descent from grey."""

    def step(rgb: jax.Array, _: None) -> tuple[jax.Array, jax.Array]:
        gradient = jax.grad(loss)(rgb, traced, matrix, observed)
        return jnp.clip(rgb - STEP * gradient, 0, 1), rgb

    last, path = jax.lax.scan(step, jnp.full(3, 0.5), length=STEPS)
    return jnp.concatenate([path, last[None]])


def example() -> Row:
    """Recover the RGB under daylight of patches from their RGB under two lamps."""
    cube = uplift.build(dim=DIM, leave_out=[FAMILY])
    sensor = cube.data.sensor
    painted = chart()
    matrices = [photograph(sensor, name).matrix for name in LIGHTS]
    observed = [painted.measured @ matrix.T for matrix in matrices]
    of_patches = jax.vmap(descend, (None, None, 0))
    paths = np.asarray(
        of_patches(
            traceable(cube),
            jnp.float32(np.concatenate(matrices)),
            jnp.float32(np.concatenate(observed, axis=1)),
        )
    )

    def errors(rgb: Array) -> Array:
        delta_e = delta_e_rgb(sensor, np.clip(rgb, 0, 1), painted.painted)
        return delta_e[~painted.outside]

    by_step = [errors(path).mean() for path in np.moveaxis(paths, 1, 0)]
    pictures = {
        **{f"under {name}": rgb for name, rgb in zip(LIGHTS, observed, strict=True)},
        **{f"{step} steps": paths[:, step] for step in (*SHOWN, STEPS)},
        "measured, D65": painted.painted,
    }
    panels = [chart_panel(rgb, title) for title, rgb in pictures.items()]
    curve = line(range(STEPS + 1), by_step)
    steps = Axis("steps")
    panels.append(Panel([curve], "mean ΔE00 to the truth", steps, Axis(log=True)))
    figure = draw(panels, 3, 2.4)
    write_figure(figure, DOCS / "gradients" / "patches.png", force=True)
    by_light = zip(LIGHTS, map(errors, observed), strict=True)
    return {
        "patches": int((~painted.outside).sum()),
        "by_light": {name: delta_e.mean() for name, delta_e in by_light},
        "mean": by_step[-1],
        "largest": errors(paths[:, -1]).max(),
        "steps_to_end": int(np.argmax(np.array(by_step) < 1.05 * by_step[-1])),
    }


def colours(cube: Cube) -> Array:
    """Colours anywhere, and as many in entry boxes."""
    random = np.random.default_rng(1)
    anywhere = random.random((CHECKED, 3))
    low, high = cube.data.entry_boxes.faces
    if not len(low):
        return anywhere
    entry = random.integers(0, len(low), CHECKED)
    inside = low[entry] + random.random((CHECKED, 3)) * (high - low)[entry]
    return np.concatenate([anywhere, np.clip(inside, 0, 1)])


def precision() -> Iterator[Row]:
    """Yield largest differences from `Cube.reflectance` of single and double precision:
    of mixtures, and of spectra that are moved to their colours.
    """
    for name, cube in cubes().items():
        rgb = colours(cube)
        inexact = is_inexact(cube.data, rgb)
        realisable = cube.data.solid.contains(rgb)
        groups = {
            "mixed": ~inexact,
            "moved": inexact & realisable,
            "unrealisable": inexact & ~realisable,
        }
        expected = cube.reflectance(rgb)
        for kind in ("float32", "float64"):
            with jax.enable_x64(kind == "float64"):
                found = np.asarray(evaluate(traceable(cube, dtype=kind), rgb))
            off = np.abs(found - expected).max(axis=1)
            for group, rows in groups.items():
                if rows.any():
                    yield {
                        "cube": name,
                        "colours": group,
                        "dtype": kind,
                        "percent": 100 * rows.mean(),
                        "largest": off[rows].max(),
                        "percentile": np.percentile(off[rows], 99),
                    }


def mean(rgb: jax.Array, traced: TraceableCube) -> jax.Array:
    """The mean reflectance of colours, of which the gradient is timed."""
    return evaluate(traced, rgb).mean()


def rates() -> Iterator[Row]:
    """Yield seconds per million colours in float32, compiled before."""
    gradient = compiled(jax.grad(mean))
    for name, (count, widths) in RATES.items():
        cube = cubes()[name]
        images = np.random.default_rng(2).random((count, 3)).astype(np.float32)
        rgb = jnp.asarray(images)
        for width in widths:
            whole = width == len(cube.wavelengths)
            at = cube.wavelengths if whole else np.linspace(400, 700, width)
            traced = traceable(cube, at)
            calls = {
                "evaluate": partial(evaluate, traced, rgb),
                "gradient": partial(gradient, rgb, traced),
                "bulk": partial(bulk.spectra(cube, at), images),
            }
            row: Row = {"cube": name, "wavelengths": width}
            for method, call in calls.items():
                jax.block_until_ready(call())  # compiles
                timing = time_call(lambda call=call: jax.block_until_ready(call()))
                row[method] = timing.wall.scaled(1e6 / count)
            yield row


QUESTIONS = {"example": example, "precision": precision, "rates": rates}
