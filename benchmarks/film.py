"""Exposure of films by tables of spectra, for docs/guides/film.md.

The films are those of spektrafilm, of whose repository a copy must be in `PROGRAM`;
nothing of it comes with this package. The program multiplies the sensitivities of a
film by a window, the product of two edges, erf in wavelength. Its setting switches the
window off.
"""

import json
import tempfile
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.special import ndtr

import uplift
from benchmarks import DOCS, ROOT, Row
from benchmarks.checker import LAYOUT, chart, chart_panel
from benchmarks.materials import materials
from uplift.colorimetry.observer import (
    grid,
    light,
    matching_functions,
    sensor,
)
from uplift.common.arrays import Array
from uplift.extras.export.film import CAT16, LAYER_WIDTH, LAYERS, write_film
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import Mark
from uplift.extras.pages.panels import draw
from uplift.extras.scene.passes.passes import scaled_power

FILM_LIGHT = "D55"
WIDTH = 2.7
"""Inches of a chart's width in the picture."""
PROGRAM = ROOT / "out" / "spektrafilm" / "src" / "spektrafilm" / "data"
"""Data of the program."""
PROGRAM_TABLE = PROGRAM / "luts" / "spectral_upsampling" / "irradiance_xy_tc.npy"
TESTED = "cie2017"
DIM = 32


# --- a chart on a film with Gaussian layers ---


def film_power() -> Array:
    """Return the light of the film, in units of a flat power with its Y."""
    return scaled_power(FILM_LIGHT) * matching_functions()[:, 1].sum()


def film_table(cube: uplift.Cube) -> tuple[float, Array]:
    """Write the table of a cube; return the error that it states, and the spectra."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.npy"
        stated = write_film(cube, path, light=FILM_LIGHT).stops
        return stated, np.load(path).astype(float)


def exposures(table: Array, rgb: Array) -> Array:
    """Look up linear sRGB (n, 3) in a table (k, k, 3) of a film, as readers do.

    They adapt to the light of the film, look up the chromaticity, and scale by X + Y +
    Z.
    """
    srgb = sensor()
    gain = (CAT16 @ light(FILM_LIGHT).white) / (CAT16 @ srgb.light.white)
    xyz = np.linalg.solve(CAT16, gain[:, None] * (CAT16 @ srgb.xyz(rgb).T))
    total = xyz.sum(axis=0)
    x, y, _ = xyz / total
    places = np.array([(1 - x) ** 2, y / (1 - x)]) * (len(table) - 1)
    layers = [
        map_coordinates(layer, places, order=1) for layer in np.moveaxis(table, -1, 0)
    ]
    return np.stack(layers, axis=1) * total[:, None]


def stops(exposure: Array, truth: Array) -> Array:
    """Return the mean |log₂| (n,) of ratios of exposures (n, 3)."""
    return np.abs(np.log2(exposure / truth)).mean(axis=1)


def expose_chart() -> list[Row]:
    """Expose the chart by tables of two cubes; return the errors in stops, and draw the
    layers as red, green and blue.
    """
    cubes = {
        "uplift, no atlas": uplift.load(),
        "uplift, with the chart": uplift.build("macbeth", dim=DIM),
    }
    painted = chart()
    power = film_power()
    layers = np.exp(-0.5 * ((grid()[:, None] - LAYERS[::-1]) / LAYER_WIDTH) ** 2)
    white = power @ layers
    measured = painted.measured * power @ layers
    panels = [chart_panel(measured / white, "measured")]
    rows = []
    for name, cube in cubes.items():
        stated, table = film_table(cube)
        exposure = exposures(table @ layers, painted.painted)
        errors = stops(exposure, measured)
        shown = exposure / white
        panels.append(chart_panel(shown, name, [write_errors(shown, errors)]))
        about = {"cube": name, "stated": stated}
        rows.append({**about, "mean": errors.mean(), "max": errors.max()})
    figure = draw(panels, len(panels), WIDTH)
    write_figure(figure, DOCS / "showcase" / "film.png", force=True)
    return rows


def write_errors(exposure: Array, errors: Array) -> Mark:
    """Write errors (24,) in stops on the patches, whose exposures are (24, 3)."""

    def draw(axes: Any) -> None:
        places = LAYOUT.patches()
        for place, level, error in zip(places, exposure, errors, strict=True):
            rows, columns = place
            colour = "w" if level.mean() < 0.25 else "k"
            corner = columns.start + 2, rows.stop - 3
            axes.text(*corner, f"{error:.2f}", fontsize=7, color=colour)

    return draw


# --- films of spektrafilm ---


def read_stocks() -> Iterator[tuple[str, Array, Array]]:
    """Yield the names of the films that are balanced for the light, and sensitivities
    (N, 3) of their layers without and with the window.
    """
    power = film_power()[:, None]
    for path in sorted(PROGRAM.glob("profiles/*.json")):
        profile = json.loads(path.read_text(encoding="utf-8"))
        about, data = profile["info"], profile["data"]
        if about["stage"] != "filming" or about["reference_illuminant"] != FILM_LIGHT:
            continue
        plain = np.nan_to_num(10 ** np.array(data["log_sensitivity"], dtype=float))
        rise, rise_width, fall, fall_width = data[
            "hanatos2025_adaptation_window_params"
        ]
        window = ndtr((grid() - rise) / rise_width) * ndtr((fall - grid()) / fall_width)
        windowed = plain * window[:, None]
        # white keeps its exposure
        windowed *= (power * plain).sum(axis=0) / (power * windowed).sum(axis=0)
        yield about["name"], plain, windowed


def measure_stocks() -> Iterator[Row]:
    """Yield the mean errors of the layers of each film in stops: by a cube that does
    not know the materials, by its table, and by the table of the program.

    Balanced exposures are relative to that of white, for which a print is filtered.
    """
    tested = materials(TESTED)
    cube = uplift.build(dim=DIM, leave_out=(TESTED,))
    power = film_power()
    lit = cube.reflectance(tested.rgb) * power
    tables = {
        "its table": film_table(cube)[1],
        "the program's table": np.load(PROGRAM_TABLE).astype(float),
    }
    for stock, plain, windowed in read_stocks():
        truth = tested.measured * power @ plain
        by_cube = stops(lit @ plain, truth).mean()
        yield {"stock": stock, "table": "the cube", "stops": by_cube}
        for (name, spectra), window in product(tables.items(), (False, True)):
            table = spectra @ (windowed if window else plain)
            exposure = exposures(table, tested.rgb)
            white = power @ plain / exposures(table, np.ones((1, 3)))
            about = {"stock": stock, "table": name, "window": window}
            for balanced, gain in ((False, 1.0), (True, white)):
                error = stops(gain * exposure, truth).mean()
                yield {**about, "stops": error, "balanced": balanced}


QUESTIONS = {"chart": expose_chart, "stocks": measure_stocks}
