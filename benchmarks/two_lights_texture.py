"""Time and memory of textures from one photograph and from two, for
docs/guides/two-lights.md.
"""

import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

from benchmarks import Row
from benchmarks.materials import SENSOR, materials
from benchmarks.performance import UPLIFT
from uplift.colorimetry import Sensor, observer
from uplift.common.arrays import Array
from uplift.lab.timing import time_process

SIDE = 2048
"""Pixels along each side of the pictures."""
PATCH = 32
"""Pixels along each side of a patch of one material."""
SHARE = 0.005
RUNS = 3


def texture_cost() -> Row:
    """Return wall seconds and peak memory in MB of both commands, which take turns."""
    random = np.random.default_rng(0)
    measured = materials("cie2017").measured
    patches = random.integers(len(measured), size=(SIDE // PATCH, SIDE // PATCH))
    shade = 0.6 + 0.4 * random.random((SIDE, SIDE, 1))
    with tempfile.TemporaryDirectory() as folder:
        day = Path(folder, "day.exr")
        tungsten = Path(folder, "tungsten.exr")
        for path, sensor in ((day, SENSOR), (tungsten, observer.sensor("sRGB", "A"))):
            colours = patch_colours(sensor, measured, patches) * shade
            noise = 1 + SHARE * random.standard_normal(colours.shape)
            write_picture(path, colours * noise)
        one = [UPLIFT, "texture", str(day), "-o", f"{folder}/one.exr", "--force"]
        two = [*one, "--also", f"A:{tungsten}"]
        costs: dict[str, list[tuple[float, float]]] = {"one": [], "two": []}
        for _ in range(RUNS):
            for name, command in (("one", one), ("two", two)):
                seconds, memory = time_process(command, 1)
                costs[name].append((seconds.median, memory))
    ratios = [
        after[0] / before[0]
        for before, after in zip(costs["one"], costs["two"], strict=True)
    ]
    row: Row = {"side": SIDE, "ratio": float(np.median(ratios))}
    for name, runs in costs.items():
        seconds_of_runs, memories = zip(*runs, strict=True)
        row[name] = {
            "seconds": float(np.median(seconds_of_runs)),
            "megabytes": max(memories),
        }
    return row


def patch_colours(sensor: Sensor, measured: Array, patches: Array) -> Array:
    """Linear RGB (height, width, 3) of patches of materials."""
    colours = sensor.rgb(measured)[patches]
    return np.kron(colours, np.ones((PATCH, PATCH, 1)))


def write_picture(path: Path, rgb: Array) -> None:
    """Write linear RGB (height, width, 3) as 32-bit floats."""
    planes = {
        channel: np.ascontiguousarray(rgb[..., number], dtype=np.float32)
        for number, channel in enumerate("RGB")
    }
    OpenEXR.File({"type": OpenEXR.scanlineimage}, planes).write(str(path))
