"""The light dial in a browser: ``make dial`` → docs/palette-dial.md and its pictures.

Frames are counted while the dial moves at each of them. The picture is held against numpy before.
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
from benchmarks.dial.introduction import INTRODUCTION
from benchmarks.page import table, write
from benchmarks.timing import ROOT
from uplift.colorimetry.srgb import encode
from uplift.design.palette import Design, design, read_palette, standard_model
from uplift.design.palette.relight_viewer.cutaway import cutaway
from uplift.design.palette.relight_viewer.page import page
from uplift.design.palette.relight_viewer.relighting import Relighting, relighting
from uplift.lab.timing import Spread, environment, spread

FOLDER = ROOT / "docs" / "palette-dial"
TASKS = ((5, 512), (7, 512), (9, 512), (7, 1024))
"""Coefficients a pixel, and pixels a side."""
RUNS, SECONDS = 5, 3.0
WINDOW = (1240, 1440)
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
WORDS = (
    "The dial moves at every frame, of which the browser shows sixty a second at most. *Script* is the time that one "
    "takes in the page's own code, *CPU* what all of the browser's processes spend on it, drawing in software. "
    f"Median (least–most) of {RUNS} runs of {SECONDS:g} s; CPU time depends least on what else the machine does, "
    "and a core to itself shows a thousand frames divided by it. "
    "*Error* is the largest of any pixel against numpy, in 8-bit codes."
)


@dataclass(frozen=True)
class Row:
    """Frames a second, milliseconds of script and of CPU a frame, error in 8-bit codes, bytes of the page."""

    coefficients: int
    side: int
    frames: Spread
    script: Spread
    cpu: Spread
    error: int
    size: int


def main() -> None:
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        tab.window(*WINDOW)
        _show(tab, Path(folder) / "page.html")
        rows = [_row(tab, Path(folder) / "page.html", *task) for task in TASKS]
        where = environment() | _browser(tab)
    head = [
        "coefficients",
        "pixels",
        "frames a second",
        "script, ms a frame",
        "CPU, ms a frame",
        "error",
        "page, MB",
    ]
    told = [_told(row) for row in rows]
    print(write("palette-dial", INTRODUCTION, [table("Frames a second", WORDS, head, told)], where))


def _show(tab: Browser, path: Path) -> None:
    """The page's pictures: whole, and its picture under each light."""
    shown = _shown(7, 512)
    path.write_text(page(shown), encoding="utf-8")
    tab.open(path)
    for number, name in enumerate(shown.lights.names, start=1):
        _press(tab, str(number))
        tab.canvas("picture")
        (FOLDER / f"{name}.jpg").write_bytes(tab.screenshot(".view", scale=0.5))
    _press(tab, "2")
    for _ in range(15):
        _press(tab, "ArrowLeft")
    tab.canvas("picture")
    (FOLDER / "page.jpg").write_bytes(tab.screenshot())


def _browser(tab: Browser) -> dict[str, str]:
    return {
        "browser": f"{tab.call('Browser.getVersion')['product']}, no graphics card",
        "meanwhile": f"{os.getloadavg()[1]:.0f} processes wanted the cores on average, the browser's own among them",
    }


def _press(tab: Browser, key: str) -> None:
    tab.evaluate(
        f"document.getElementById('dial').dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}}))"
    )


def _row(tab: Browser, path: Path, coefficients: int, side: int) -> Row:
    shown = _shown(coefficients, side)
    path.write_text(page(shown), encoding="utf-8")
    tab.open(path)
    error = _error(tab, shown)
    measured = [_moved(tab) for _ in range(RUNS + 1)][1:]
    assert tab.errors == [], tab.errors
    frames, script, cpu = (spread(list(column)) for column in zip(*measured, strict=True))
    return Row(coefficients, side, frames, script, cpu, error, path.stat().st_size)


def _moved(tab: Browser) -> tuple[float, float, float]:
    """Frames a second, and milliseconds of script and of CPU a frame."""
    begin = tab.cpu()
    frames, rate, script = tab.evaluate(f"{MOVE}({SECONDS})")
    return rate, script, 1000 * (tab.cpu() - begin) / frames


@functools.cache
def _designed(coefficients: int) -> Design:
    palette = dataclasses.replace(read_palette(FOLDER / "engine.toml"), count=coefficients)
    return design(palette, standard_model(palette.sensor, coefficients))


def _shown(coefficients: int, side: int) -> Relighting:
    found = _designed(coefficients)
    return relighting("engine", found, cutaway(len(found.palette.materials), side))


def _error(tab: Browser, shown: Relighting) -> int:
    """The largest difference to numpy under equal parts of all lights, in 8-bit codes."""
    _press(tab, "0")
    seen, lights = tab.canvas("picture")[..., :3], len(shown.lights.names)
    wanted = np.rint(255 * encode(shown.rgb(np.full(lights, 1 / lights))))
    error = int(np.abs(seen - wanted).max())
    assert error <= 1, f"{error} codes off"
    return error


def _told(row: Row) -> list[str]:
    return [
        str(row.coefficients),
        f"{row.side} × {row.side}",
        f"{row.frames:.0f}",
        f"{row.script:.1f}",
        f"{row.cpu:.0f}",
        str(row.error),
        f"{row.size / 1e6:.1f}",
    ]


if __name__ == "__main__":
    main()
