"""Size and time of sparse cubes for real images, for docs/scenes.md."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import MACBETH, record
from benchmarks.pictures import Picture, pictures
from uplift.colorimetry.delta_e import delta_e_spectra
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


@dataclass(frozen=True, eq=False)
class Build:
    """A cube, the CPU seconds of its build, and the bytes of its file."""

    cube: Cube
    seconds: Spread
    size: int


@dataclass(frozen=True)
class Difference:
    """Differences between the spectra of a sparse and a complete cube, if there are two."""

    reflectance: float | None = None
    """Largest difference of reflectances."""
    mean_delta_e: float | None = None
    """Mean over colours of the largest ΔE00 under the lights of the cube."""
    largest_delta_e: float | None = None


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    images = list(pictures())
    uplift.build(ATLAS, dim=32)  # compile before timing
    sections = [measure(images, space, dim) for space, dim in LATTICES]
    record("scenes", precision="full", runs=RUNS, sections=sections)


def measure(images: list[Picture], space: str, dim: int) -> dict[str, Any]:
    """Compare the complete cube with a sparse cube for each image, and for all images."""
    complete = _build(space, dim, ())
    rows = [_row("complete cube", complete, complete)]
    for picture in images:
        sparse = _build(space, dim, (picture,))
        name = f"{picture.path.name} ({picture.package})"
        rows.append(_row(name, sparse, complete, _difference(sparse.cube, complete.cube, picture)))
    rows.append(_row("all images", _build(space, dim, images), complete))
    return {"space": space, "dim": dim, "nodes": complete.cube.data.lattice.size, "rows": rows}


def _build(space: str, dim: int, scene: Sequence[Picture]) -> Build:
    images = Images(tuple(picture.path for picture in scene)) if scene else None
    made: list[Cube] = []
    _, cpu = time_calls(lambda: made.append(uplift.build(ATLAS, dim=dim, space=space, scene=images)), RUNS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        made[-1].save(path)
        return Build(made[-1], cpu, path.stat().st_size)


def _row(name: str, sparse: Build, complete: Build, difference: Difference = Difference()) -> dict[str, Any]:
    nodes = int(sparse.cube.data.points.present.sum())
    return {
        "scene": name,
        "nodes": nodes,
        "node_share": nodes / complete.cube.data.lattice.size,
        "megabytes": sparse.size / 1e6,
        "size_share": sparse.size / complete.size,
        "seconds": sparse.seconds,
        "time_share": sparse.seconds.median / complete.seconds.median,
        **asdict(difference),
    }


def _difference(sparse: Cube, complete: Cube, picture: Picture) -> Difference:
    """Compare spectra of colours of an image, as scenes read it: decoders of JPEG differ by a code value."""
    data = sparse.data
    colours = np.concatenate(list(Images((picture.path,)).colours(picture.path, data.sensor)))
    sample = np.random.default_rng(0).permutation(colours)[:SAMPLE]
    ours, theirs = sparse.reflectance(sample), complete.reflectance(sample)
    lights = [light(name, data.sensor.observer, *data.sensor.range) for name in SCENE_LIGHTS]
    errors = np.max([delta_e_spectra(light, ours, theirs) for light in lights], axis=0)
    return Difference(float(np.abs(ours - theirs).max()), float(errors.mean()), float(errors.max()))


if __name__ == "__main__":
    main()
