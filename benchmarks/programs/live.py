"""Frames per second of the live page in Chromium, with software rendering."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from benchmarks.browser import Browser, browser
from uplift.lab.timing import Spread, spread
from uplift.lookup import Cube
from uplift.report.live_page import write_page

SIDES, SECONDS = (512, 1024), 2.0
TASKS = {
    "mix of the lights": ("mix", "input", "(k * 7) % 101"),
    "first light": ("light-a", "change", '["D65", "A", "D50", "FL11"][k % 4]'),
}
"""Control, event and the values that it takes."""
OPEN = """(async side => {
  const picture = new OffscreenCanvas(side, side), context = picture.getContext("2d");
  const pixels = context.createImageData(side, side);
  for (let k = 0; k < pixels.data.length; k++) pixels.data[k] = k % 4 === 3 ? 255 : (k * 2654435761) >>> 24;
  context.putImageData(pixels, 0, 0);
  const files = new DataTransfer(), input = document.getElementById("file");
  files.items.add(new File([await picture.convertToBlob()], "noise.png", { type: "image/png" }));
  input.files = files.files;
  input.dispatchEvent(new Event("change"));
  while (document.getElementById("view").width !== side) await new Promise(requestAnimationFrame);
})"""
MOVE = """(async seconds => {
  const element = document.getElementById("ID"), begin = performance.now();
  let k = 0;
  while (performance.now() - begin < 1000 * seconds) {
    element.value = VALUE;
    element.dispatchEvent(new Event("EVENT"));
    await new Promise(requestAnimationFrame);
    k++;
  }
  return [k, 1000 * k / (performance.now() - begin)];
})"""


@dataclass(frozen=True)
class Frames:
    """Frames per second, and CPU milliseconds of all processes of the browser per frame."""

    side: int
    task: str
    frames: Spread
    cpu: Spread


def measure(cube: Cube, runs: int) -> tuple[list[Frames], str]:
    """Change a control at every frame, for an image of random colours. Returns the frames, and the browser's name."""
    rows = []
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        path = Path(folder) / "page.html"
        write_page(cube.data, path)
        for side in SIDES:
            tab.open(path)
            tab.evaluate(f"{OPEN}({side})")
            for task, (control, event, value) in TASKS.items():
                script = MOVE.replace("ID", control).replace("EVENT", event).replace("VALUE", value)
                measured = [_move(tab, script) for _ in range(runs + 1)][1:]
                frames, cpu = (spread(list(column)) for column in zip(*measured, strict=True))
                rows.append(Frames(side, task, frames, cpu))
        assert tab.errors == [], tab.errors
        return rows, tab.call("Browser.getVersion")["product"]


def _move(tab: Browser, script: str) -> tuple[float, float]:
    begin = tab.cpu()
    frames, rate = tab.evaluate(f"{script}({SECONDS})")
    return rate, 1000 * (tab.cpu() - begin) / frames
