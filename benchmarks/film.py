"""Exposure of films by tables of spectra, for docs/guides/film.md.

The films are those of spektrafilm, if a copy of its repository is in `PROGRAM`; nothing
of it comes with this package. Their layers are exposed to measured reflectances under
`FILM_LIGHT`: by their spectra, by those of a cube that does not know their family, by
the table of the cube, and by the table of the program. The program multiplies the
sensitivities by a window, the product of two edges, erf in wavelength. Its setting
switches the window off.
"""

import json
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.special import ndtr

import uplift
from benchmarks import ROOT, Row, record
from benchmarks.checker import BACKGROUND, Layout, chart
from benchmarks.materials import materials
from benchmarks.showcase import ATLAS, DIM, FOLDER, MEASURED, PLAIN
from uplift.colorimetry import Sensor
from uplift.colorimetry.observer import (
    DEFAULT_OBSERVER,
    grid,
    illuminant_spd,
    light,
    matching_functions,
    sensor,
)
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import encode
from uplift.extras.export import write_film
from uplift.extras.export.film import CAT16, LAYER_WIDTH, LAYERS, SHARE
from uplift.extras.pages.figure import new_figure, show_image, write_png

FILM_LIGHT = "D55"
FILM_SIZE = (11.2, 2.9)
LAYOUT = Layout(patch=32, gap=4)
PROGRAM = ROOT / "out" / "spektrafilm" / "src" / "spektrafilm" / "data"
"""Data of the program; without them its films are not measured."""
PROGRAM_TABLE = PROGRAM / "luts" / "spectral_upsampling" / "irradiance_xy_tc.npy"
TESTED = "cie2017"
SHARES = (0.2, 0.3, 0.4, 0.5, 0.6, 0.8)
"""Luminances of the stored reflectances that are compared."""
SHARE_SETS = (TESTED, "rawtoaces", "pmc")


@dataclass(frozen=True, eq=False)
class Stock:
    """A film: sensitivities (N, 3) of its layers, without and with the window."""

    name: str
    plain: Array
    windowed: Array


def main() -> None:
    """Expose the chart and draw it, and measure the films of the program."""
    FOLDER.mkdir(exist_ok=True)
    expose_chart()
    if PROGRAM_TABLE.exists():
        stocks = read_stocks()
        record(
            "film",
            "film-stocks",
            light=FILM_LIGHT,
            materials=TESTED,
            stocks=measure_stocks(stocks),
            shares=[measure_shares(stocks, name) for name in SHARE_SETS],
        )


def expose_chart() -> None:
    """Expose the chart on a film by tables, draw the layers as red, green and blue, and
    store the errors in stops.
    """
    cubes = {PLAIN: uplift.load(), ATLAS: uplift.build("macbeth", dim=DIM)}
    painted = chart()
    power = film_power()
    layers = np.exp(-0.5 * ((grid()[:, None] - LAYERS[::-1]) / LAYER_WIDTH) ** 2)
    measured = painted.measured * power @ layers
    figure = new_figure(*FILM_SIZE)
    panels = figure.subplots(1, 1 + len(cubes))
    draw_layers(panels[0], MEASURED, measured / (power @ layers))
    rows = []
    for axes, (name, cube) in zip(panels[1:], cubes.items(), strict=True):
        stated, table = film_table(cube, SHARE)
        exposure = exposures(table @ layers, cube.data.sensor, painted.painted)
        stops = np.abs(np.log2(exposure / measured)).mean(axis=1)
        draw_layers(axes, name, exposure / (power @ layers), stops)
        rows.append(
            {
                "cube": name,
                "stated": stated,
                "mean": stops.mean(),
                "largest": stops.max(),
            }
        )
    write_png(figure, FOLDER / "film.png", force=True)
    record("film", light=FILM_LIGHT, cubes=rows)


def film_power() -> Array:
    """Return the light of the film with Y = 1."""
    spd = illuminant_spd(FILM_LIGHT)
    luminous = matching_functions(DEFAULT_OBSERVER)[:, 1]
    return spd / (spd @ luminous / luminous.sum())


def film_table(cube: uplift.Cube, share: float) -> tuple[float, Array]:
    """Write the table of a cube; return the error that it states, and the spectra."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.npy"
        stated = write_film(cube, path, light=FILM_LIGHT, share=share).stops
        return stated, np.load(path).astype(float)


def read_stocks() -> list[Stock]:
    """Read the films that are balanced for the light."""
    stocks = []
    power = film_power()[:, None]
    for path in sorted(PROGRAM.glob("profiles/*.json")):
        profile = json.loads(path.read_text(encoding="utf-8"))
        about = profile["info"]
        if about["stage"] != "filming" or about["reference_illuminant"] != FILM_LIGHT:
            continue
        data = profile["data"]
        plain = np.nan_to_num(10 ** np.array(data["log_sensitivity"], dtype=float))
        rise, rise_width, fall, fall_width = data[
            "hanatos2025_adaptation_window_params"
        ]
        window = ndtr((grid() - rise) / rise_width) * ndtr((fall - grid()) / fall_width)
        windowed = plain * window[:, None]
        # white keeps its exposure
        windowed *= (power * plain).sum(axis=0) / (power * windowed).sum(axis=0)
        stocks.append(Stock(about["name"], plain, windowed))
    return stocks


def measure_stocks(stocks: Sequence[Stock]) -> list[Row]:
    """Return the mean errors of the layers of each film in stops."""
    tested = materials(TESTED)
    cube = uplift.build(dim=DIM, leave_out=(TESTED,))
    lit = cube.reflectance(tested.rgb) * film_power()
    _, table = film_table(cube, SHARE)
    tables = {"table": table, "program": np.load(PROGRAM_TABLE).astype(float)}
    rows = []
    for stock in stocks:
        truth = tested.measured * film_power() @ stock.plain
        row: Row = {"stock": stock.name, "cube": stops(lit @ stock.plain, truth)}
        sensitivities = {"": stock.plain, ", window": stock.windowed}
        for (name, spectra), (window, layers) in product(
            tables.items(), sensitivities.items()
        ):
            exposed = spectra @ layers
            row[f"{name}{window}"] = table_stops(exposed, tested.rgb, truth)
            # white is exposed as it should be, as in a print that is balanced for white
            white = exposures(exposed, sensor(), np.ones((1, 3)))
            exposed *= film_power() @ stock.plain / white
            row[f"{name}{window}, balanced"] = table_stops(exposed, tested.rgb, truth)
        rows.append(row)
    return rows


def measure_shares(stocks: Sequence[Stock], name: str) -> Row:
    """Return the mean error of all films by the luminance of the table's spectra."""
    tested = materials(name)
    cube = uplift.build(dim=DIM, leave_out=(name,))
    errors = {}
    for share in SHARES:
        _, table = film_table(cube, share)
        by_stock = []
        for stock in stocks:
            truth = tested.measured * film_power() @ stock.plain
            by_stock.append(table_stops(table @ stock.plain, tested.rgb, truth))
        errors[str(share)] = float(np.mean(by_stock))
    return {"materials": name, "stops": errors}


def table_stops(table: Array, rgb: Array, truth: Array) -> float:
    """Mean error of exposures of linear sRGB (n, 3) by a table (k, k, 3)."""
    return stops(exposures(table, sensor(), rgb), truth)


def stops(exposure: Array, truth: Array) -> float:
    """Mean |log₂| of ratios of exposures (n, 3)."""
    return float(np.abs(np.log2(exposure / truth)).mean())


def exposures(table: Array, srgb: Sensor, rgb: Array) -> Array:
    """Look up linear sRGB (n, 3) in a table (k, k, 3) of a film, as readers do.

    They adapt to the light of the film, look up the chromaticity, and scale by X + Y +
    Z.
    """
    gain = (CAT16 @ light(FILM_LIGHT).white) / (CAT16 @ srgb.light.white)
    xyz = np.linalg.solve(CAT16, gain[:, None] * (CAT16 @ srgb.xyz(rgb).T))
    total = xyz.sum(axis=0)
    x, y, _ = xyz / total
    places = np.array([(1 - x) ** 2, y / (1 - x)]) * (len(table) - 1)
    layers = [
        map_coordinates(layer, places, order=1) for layer in np.moveaxis(table, -1, 0)
    ]
    return np.stack(layers, axis=1) * total[:, None]


def draw_layers(
    axes: Any, name: str, exposure: Array, stops: Sequence[float] = ()
) -> None:
    """Show exposures (24, 3) as linear RGB, with errors in stops on the patches."""
    image = LAYOUT.paint(exposure, np.full(3, BACKGROUND))
    for (rows, columns), error in zip(LAYOUT.patches(), stops, strict=False):
        axes.text(
            columns.start + 2,
            rows.stop - 3,
            f"{error:.2f}",
            fontsize=8,
            color="w" if image[rows, columns].mean() < 0.25 else "k",
        )
    show_image(axes, encode(np.clip(image, 0, 1)), interpolation="nearest")
    axes.set_title(name)
