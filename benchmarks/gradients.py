"""Traced spectra: an example by gradient descent, precision and rates, for
docs/guides/gradients.md.
"""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

import uplift
from benchmarks import DOCS, Row, record
from benchmarks.checker import Layout, chart, show_srgb
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array
from uplift.common.compilation import compiled
from uplift.extras.pages.figure import (
    INK,
    new_figure,
    style_axes,
    styled,
    write_png,
)
from uplift.extras.photographs import photograph
from uplift.lab.timing import time_calls
from uplift.lookup import Cube, bulk
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
COLOURS = 1_000_000
"""Colours of the rates."""
WIDE_COLOURS = 20_000
"""Colours of those of a wide-gamut cube, which take longer."""
RUNS = 5
CHECKED = 100_000
"""Colours of the precision."""
WIDTHS = (3, 16, 31, 81)
"""Wavelengths of the rates."""
LAYOUT = Layout(32, 4)


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


def recover(cube: Cube) -> Row:
    """Recover the RGB under daylight of patches from their RGB under two lamps."""
    sensor = cube.data.sensor
    painted = chart()
    further = [photograph(sensor, name) for name in LIGHTS]
    matrix = np.concatenate([taken.matrix for taken in further])
    observed = painted.measured @ matrix.T
    traced = traceable(cube)
    of_patches = jax.vmap(descend, (None, None, 0))
    paths = np.asarray(of_patches(traced, jnp.float32(matrix), jnp.float32(observed)))
    inside = ~painted.outside

    def errors(rgb: Array) -> Array:
        return delta_e_rgb(sensor, np.clip(rgb, 0, 1), painted.painted)[inside]

    by_step = [errors(paths[:, step]).mean() for step in range(STEPS + 1)]
    alone = {
        name: errors(observed[:, 3 * number : 3 * number + 3]).mean()
        for number, name in enumerate(LIGHTS)
    }
    draw(paths, observed, painted.painted, np.array(by_step))
    return {
        "lights": LIGHTS,
        "patches": int(inside.sum()),
        "steps": STEPS,
        "step": STEP,
        "by_light": alone,
        "mean": by_step[-1],
        "largest": errors(paths[:, -1]).max(),
        "steps_to_end": int(np.argmax(np.array(by_step) < 1.05 * by_step[-1])),
    }


def draw(paths: Array, observed: Array, truth: Array, errors: Array) -> None:
    """Draw the chart under the lamps, in steps of the descent, and its errors."""
    pictures = {
        "under A": observed[:, :3],
        "under FL11": observed[:, 3:],
        **{f"{step} steps": paths[:, step] for step in SHOWN},
        f"{STEPS} steps": paths[:, -1],
        "measured, D65": truth,
    }
    with styled():
        figure = new_figure(9.6, 2.9)
        grid = figure.add_gridspec(2, 6)
        for number, (title, rgb) in enumerate(pictures.items()):
            axes = figure.add_subplot(grid[number // 4, number % 4])
            image = LAYOUT.paint(np.clip(rgb, 0, 1), np.full(3, 0.03))
            show_srgb(axes, image)
            axes.set_title(title, fontsize=9, color=INK)
        axes = figure.add_subplot(grid[:, 4:])
        axes.plot(errors, color=INK)
        axes.set(xlabel="steps", ylabel="mean ΔE00 to the measured colours")
        axes.set_yscale("log")
        axes.set_xlim(0, STEPS)
        style_axes(axes)
        figure.set_dpi(150)
        write_png(figure, DOCS / "gradients" / "patches.png", force=True)


def colours(cube: Cube, count: int) -> Array:
    """Colours anywhere, and as many in entry boxes."""
    random = np.random.default_rng(1)
    anywhere = random.random((count, 3))
    low, high = cube.data.entry_boxes.faces
    if not len(low):
        return anywhere
    entry = random.integers(0, len(low), count)
    inside = low[entry] + random.random((count, 3)) * (high - low)[entry]
    return np.concatenate([anywhere, np.clip(inside, 0, 1)])


def precision(name: str, cube: Cube) -> Iterator[Row]:
    """Yield largest differences from `Cube.reflectance` of single and double precision:
    of mixtures, and of spectra that are moved to their colours.
    """
    rgb = colours(cube, CHECKED)
    inexact = is_inexact(cube.data, rgb)
    realisable = np.ones(len(rgb), dtype=bool)
    realisable[inexact] = cube.data.solid.contains(rgb[inexact])
    groups = {
        "mixed": ~inexact,
        "moved": inexact & realisable,
        "unrealisable": inexact & ~realisable,
    }
    expected = cube.reflectance(rgb)
    for kind in (np.float32, np.float64):
        with jax.enable_x64(kind == np.float64):
            found = np.asarray(evaluate(traceable(cube, dtype=kind), rgb))
        off = np.abs(found - expected).max(axis=1)
        for group, rows in groups.items():
            if rows.any():
                yield {
                    "cube": name,
                    "colours": group,
                    "dtype": np.dtype(kind).name,
                    "percent": 100 * rows.mean(),
                    "largest": off[rows].max(),
                    "percentile": np.percentile(off[rows], 99),
                }


def mean(rgb: jax.Array, traced: TraceableCube) -> jax.Array:
    """The mean reflectance of colours, of which the gradient is timed."""
    return evaluate(traced, rgb).mean()


def rates(name: str, cube: Cube, widths: tuple[int, ...], count: int) -> Iterator[Row]:
    """Yield seconds per million colours in float32, compiled before."""
    rgb = jnp.asarray(np.random.default_rng(2).random((count, 3)), jnp.float32)
    images = np.asarray(rgb)
    for width in widths:
        at = cube.wavelengths
        if width < len(at):
            at = np.linspace(400, 700, width)
        traced = traceable(cube, at)
        sample = bulk.spectra(cube, at)
        gradient = compiled(jax.grad(mean))
        calls: dict[str, Callable[[], Any]] = {
            "evaluate": partial(evaluate, traced, rgb),
            "gradient": partial(gradient, rgb, traced),
            "bulk": partial(sample, images),
        }
        row: Row = {"cube": name, "wavelengths": width}
        for method, call in calls.items():
            jax.block_until_ready(call())
            wall, _ = time_calls(lambda call=call: jax.block_until_ready(call()), RUNS)
            row[method] = wall.scaled(COLOURS / count)
        yield row


def main() -> None:
    """Recover, measure and store."""
    cube = uplift.load()
    macbeth = uplift.build("macbeth", dim=32)
    wide = uplift.load("acescg")
    cubes = {"packaged": cube, "macbeth, 32³": macbeth, "packaged ACEScg": wide}
    rows = []
    for name, checked in cubes.items():
        rows += precision(name, checked)
    record(
        "gradients",
        example=recover(uplift.build(dim=DIM, leave_out=[FAMILY])),
        colours=COLOURS,
        checked=CHECKED,
        device=jax.devices()[0].platform,
        precision=rows,
        rates=[
            *rates("macbeth, 32³", macbeth, WIDTHS, COLOURS),
            *rates("packaged ACEScg", wide, WIDTHS[::3], WIDE_COLOURS),
        ],
    )
