"""The relighting viewer in a browser: ``make dial`` writes docs/data/palette-dial.json and the pictures of the page.

Frames are counted while the dial moves at every frame. Before that, the picture is compared with NumPy.
"""

from __future__ import annotations

import dataclasses
import functools
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.browser import Browser, browser
from benchmarks.record import ROOT, write
from uplift.colorimetry.srgb import encode
from uplift.design.palette import Design, design, read_palette, standard_model
from uplift.design.palette.picture import cutaway
from uplift.design.palette.relight_page import Relighting, page, relighting
from uplift.lab.timing import Spread, environment, spread
from uplift.samples import sample_path

FOLDER = ROOT / "docs" / "palette-dial"
TASKS = ((5, 512), (7, 512), (9, 512), (7, 1024))
"""Coefficients per pixel, and pixels per side."""
RUNS, SECONDS = 5, 3.0
WINDOW = (1240, 1440)
CURVE_STEPS = 1 << 16
"""Entries of the table of the sRGB curve in relight_page.js."""
MOVE = """(async seconds => {
  const next = requestAnimationFrame.bind(window), script = [];
  window.requestAnimationFrame = frame => next(now => {
    const begin = performance.now();
    frame(now);
    script.push(performance.now() - begin);
  });
  const press = key => document.getElementById("dial").dispatchEvent(new KeyboardEvent("keydown", { key }));
  const ways = ["ArrowDown", "ArrowRight", "ArrowUp", "ArrowLeft"];
  const begin = performance.now();
  let frames = 0;
  while (performance.now() - begin < 1000 * seconds) {
    press(ways[(frames >> 4) & 3]);
    await new Promise(next);
    frames++;
  }
  window.requestAnimationFrame = next;
  return [frames, 1000 * frames / (performance.now() - begin), script.sort((a, b) => a - b)[script.length >> 1]];
})"""


@dataclass(frozen=True)
class Row:
    """Frames per second, milliseconds of script and of CPU per frame, error in 8-bit codes, size of the page."""

    coefficients: int
    side: int
    frames: Spread
    script: Spread
    cpu: Spread
    error: int
    megabytes: float


def main() -> None:
    """Measure, take the pictures and store."""
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        tab.window(*WINDOW)
        path = Path(folder) / "page.html"
        _take_pictures(tab, path)
        rows = [_measure(tab, path, *task) for task in TASKS]
        product = tab.call("Browser.getVersion")["product"]
    write(
        "palette-dial",
        "make dial",
        precision="full",
        environment={
            **environment(),
            "browser": product,
            "load": f"{os.getloadavg()[1]:.0f} processes on average",
        },
        curve_steps=CURVE_STEPS,
        runs=RUNS,
        seconds=SECONDS,
        rows=rows,
    )


def _take_pictures(tab: Browser, path: Path) -> None:
    """Take screenshots of the page, and of its picture under each light."""
    view = _view(7, 512)
    path.write_text(page(view), encoding="utf-8")
    tab.open(path)
    for number, name in enumerate(view.lights, start=1):
        _press(tab, str(number))
        tab.canvas("picture")
        (FOLDER / f"{name}.jpg").write_bytes(tab.screenshot(".view", scale=0.5))
    _press(tab, "2")
    for _ in range(15):
        _press(tab, "ArrowLeft")
    tab.canvas("picture")
    (FOLDER / "page.jpg").write_bytes(tab.screenshot())


def _press(tab: Browser, key: str) -> None:
    tab.evaluate(f"document.getElementById('dial').dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}}))")


def _measure(tab: Browser, path: Path, coefficients: int, side: int) -> Row:
    view = _view(coefficients, side)
    path.write_text(page(view), encoding="utf-8")
    tab.open(path)
    error = _error(tab, view)
    measured = [_move_dial(tab) for _ in range(RUNS + 1)][1:]
    assert tab.errors == [], tab.errors
    frames, script, cpu = (spread(list(column)) for column in zip(*measured, strict=True))
    return Row(coefficients, side, frames, script, cpu, error, path.stat().st_size / 1e6)


def _move_dial(tab: Browser) -> tuple[float, float, float]:
    """Return frames per second, and milliseconds of script and of CPU per frame."""
    begin = tab.cpu()
    frames, rate, script = tab.evaluate(f"{MOVE}({SECONDS})")
    return rate, script, 1000 * (tab.cpu() - begin) / frames


@functools.cache
def _design(coefficients: int) -> Design:
    palette = dataclasses.replace(read_palette(sample_path("engine.toml")), count=coefficients)
    return design(palette, standard_model(palette.sensor, coefficients))


def _view(coefficients: int, side: int) -> Relighting:
    palette_design = _design(coefficients)
    return relighting("engine", palette_design, cutaway(len(palette_design.palette.materials), side))


def _error(tab: Browser, view: Relighting) -> int:
    """Return the largest difference from NumPy under equal parts of all lights, in 8-bit codes."""
    _press(tab, "0")
    drawn, lights = tab.canvas("picture")[..., :3], len(view.lights)
    expected = np.rint(255 * encode(view.rgb(np.full(lights, 1 / lights))))
    error = int(np.abs(drawn - expected).max())
    assert error <= 1, f"{error} codes off"
    return error


if __name__ == "__main__":
    main()
