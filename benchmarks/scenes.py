"""Size and time of sparse cubes for real images, for docs/plan.md."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import MACBETH, record
from benchmarks.pictures import Picture, pictures
from uplift.colorimetry import delta_e_spectra
from uplift.colorimetry.lights import SCENE_LIGHTS
from uplift.colorimetry.observer import light
from uplift.io.scene_colours import Images
from uplift.lab.timing import Spread, time_calls
from uplift.lookup import Cube

ATLAS = MACBETH
LATTICES = (("sRGB", 32), ("sRGB", 64), ("sRGB", 128), ("ACEScg", 32))
RUNS = 3
SAMPLE = 20_000
"""Colours of an image at which complete and sparse cubes are compared."""


Measured = tuple[Cube, Spread, int]
"""A cube, the CPU seconds of its build, and the bytes of its file."""


def main() -> None:
    """Measure and store."""
    images = list(pictures())
    uplift.build(ATLAS, dim=32)  # compile before timing
    sections = [measure(images, space, dim) for space, dim in LATTICES]
    record("scenes", runs=RUNS, sections=sections)


def measure(images: list[Picture], space: str, dim: int) -> dict[str, Any]:
    """Compare the complete cube with a sparse cube for each image, and for all images."""
    complete = build(space, dim, [])
    rows = [compare("complete cube", complete, complete)]
    for picture in images:
        sparse = build(space, dim, [picture])
        name = f"{picture.path.name} ({picture.package})"
        rows.append(compare(name, sparse, complete) | differences(sparse[0], complete[0], picture))
    rows.append(compare("all images", build(space, dim, images), complete))
    return {"space": space, "dim": dim, "nodes": complete[0].data.lattice.size, "rows": rows}


def build(space: str, dim: int, scene: list[Picture]) -> Measured:
    """Build a cube for images, or a complete one."""
    images = Images(tuple(picture.path for picture in scene)) if scene else None
    made: list[Cube] = []
    _, cpu = time_calls(lambda: made.append(uplift.build(ATLAS, dim=dim, space=space, scene=images)), RUNS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        made[-1].save(path)
        return made[-1], cpu, path.stat().st_size


def compare(name: str, sparse: Measured, complete: Measured) -> dict[str, Any]:
    """Compare nodes, size and time; differences of answers are unknown."""
    (cube, seconds, size), (all_nodes, all_seconds, all_size) = sparse, complete
    nodes = int(cube.data.points.present.sum())
    return {
        "scene": name,
        "nodes": nodes,
        "node_share": nodes / all_nodes.data.lattice.size,
        "megabytes": size / 1e6,
        "size_share": size / all_size,
        "seconds": seconds,
        "time_share": seconds.median / all_seconds.median,
        **dict.fromkeys(("reflectance", "mean_delta_e", "largest_delta_e")),
    }


def differences(sparse: Cube, complete: Cube, picture: Picture) -> dict[str, Any]:
    """Return the largest difference of reflectances, and mean and largest of the largest ΔE00 under the lights.

    The colours are those of an image, as scenes read it: decoders of JPEG differ by a code value.
    """
    sensor = sparse.data.sensor
    colours = np.concatenate(list(Images((picture.path,)).colours(picture.path, sensor)))
    sample = np.random.default_rng(0).permutation(colours)[:SAMPLE]
    ours, theirs = sparse.reflectance(sample), complete.reflectance(sample)
    lights = [light(name, sensor.observer, *sensor.range) for name in SCENE_LIGHTS]
    errors = np.max([delta_e_spectra(light, ours, theirs) for light in lights], axis=0)
    change = np.abs(ours - theirs).max()
    return {"reflectance": change, "mean_delta_e": errors.mean(), "largest_delta_e": errors.max()}
