"""Sparse cubes for real images, and plans for these and the sample kitchen, for
docs/plan.md and its picture.
"""

import json
import shlex
import shutil
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, MACBETH, UPLIFT, Row
from benchmarks.pictures import pictures
from uplift.colorimetry import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.observer import light
from uplift.extras.pages.figure import ACCENT, INK, write_figure
from uplift.extras.pages.format import format_size
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Axis, Dot, draw
from uplift.extras.pages.pareto import front_panel
from uplift.extras.texture.scene_colours import Images
from uplift.lab.timing import run_command, time_call
from uplift.lookup import Cube
from uplift.samples import copy_samples

DIM = 64
RUNS = 3
SAMPLE = 20_000
"""Colours of an image at which complete and sparse cubes are compared."""
KITCHEN = ("still-life.png", "wood.png")
FIVE = ("D65", "A", "FL2", "FL11", "LED-B3")


@dataclass(frozen=True)
class Case:
    """Pictures, an atlas or none, lights and a tolerance."""

    pictures: tuple[str, ...]
    atlas: str
    lights: tuple[str, ...]
    tolerance: float
    quick: bool = True

    def scene(self) -> str:
        """Return the text of the scene file."""
        atlases = f'atlases = "{self.atlas}"\n' if self.atlas else ""
        return (
            f"textures = {json.dumps(self.pictures)}\n{atlases}"
            f"lights = {json.dumps(self.lights)}\ntolerance = {self.tolerance}\n"
        )


CASES = (
    Case(KITCHEN, "paints.csv", ("D65", "A", "FL11"), 1.0, quick=False),
    Case(KITCHEN, "paints.csv", ("FL11", "HP1", "LED-RGB1"), 0.15, quick=False),
    Case(("astronaut.png",), "macbeth.txt", ("D65", "FL11"), 1.0),
    Case(("coffee.png",), "macbeth.txt", FIVE, 1.0),
    Case(("rocket.jpg",), "", FIVE, 1.0),
    Case(("chelsea.png",), "", ("D65", "D55"), 1.0),
)
"""The front of the first case is shown."""


@cache
def plan(case: Case) -> tuple[Row, float, int | None]:
    """Return the plan of a scene, its CPU seconds, and the bytes of a cube, if any."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_samples(folder)
        for source in (*(picture.path for picture in pictures()), MACBETH):
            shutil.copy(source, folder)
        (folder / "scene.toml").write_text(case.scene(), encoding="utf-8")
        quick = "--quick" if case.quick else ""
        run = call(folder, f"plan scene.toml {quick}")
        found = json.loads((folder / "scene.plan.json").read_text(encoding="utf-8"))
        size = None
        if found["build"]:
            call(folder, "build --plan scene.plan.json -o scene.uplift")
            size = (folder / "scene.uplift").stat().st_size
    return found, run, size


def call(folder: Path, words: str) -> float:
    """Run a command of this package; return its CPU seconds."""
    return run_command([UPLIFT, *shlex.split(words)], folder=folder).cpu


def plans() -> Iterator[Row]:
    """Yield the chosen candidates, their errors and the cost of the search."""
    for case in CASES:
        found, seconds, size = plan(case)
        error = found["error"]
        yield {
            "textures": case.pictures,
            "lights": case.lights,
            "tolerance": case.tolerance,
            "choice": found["name"],
            "predicted": error["predicted"]["quantile"],
            "confirmed": error["confirmed"]["quantile"],
            "rgb": error["without_spectra"],
            "expected": error["expected_of_measurements"],
            "bytes": size,
            "measured": found["search"]["measured"],
            "considered": found["search"]["considered"],
            "cpu_s": seconds,
        }


def front() -> None:
    """Draw error over memory and over samples for the front of a plan."""
    found, *_ = plan(CASES[0])
    axes = {
        "memory": Axis("cube file and pixels", log=True, text=format_size),
        "samples": Axis("samples per ray", log=True, text="{:g}".format),
    }
    chosen = line([], [], "chosen", ACCENT, marker="D", linestyle="")
    panels = []
    for key, axis in axes.items():
        dots = []
        for candidate in found["front"]:
            name = candidate["name"]
            style = (ACCENT, "D") if name == found["name"] else (INK, "o")
            error = candidate["error"]["quantile"]
            dots.append(Dot(candidate[key], error, name, *style))
        panels.append(front_panel(f"ΔE00 over {key}", axis, (), dots, [chosen]))
    figure = draw(panels, 2, legend="below")
    write_figure(figure, DOCS / "plan" / "front.png", force=True)


def sparse() -> Iterator[Row]:
    """Yield nodes, size and CPU seconds of the complete cube, and of those for images,
    with the largest ΔE00 between the two.
    """
    build = partial(uplift.build, MACBETH, dim=DIM)
    complete = build()
    yield {"scene": "complete cube", **cost(build), "largest_delta_e": None}
    images = list(pictures())
    for picture in images:
        scene = Images((picture.path,))
        yield {
            "scene": f"{picture.path.name} ({picture.package})",
            **cost(partial(build, scene=scene)),
            "largest_delta_e": largest_difference(build(scene=scene), complete, scene),
        }
    everything = Images(tuple(picture.path for picture in images))
    rest = cost(partial(build, scene=everything))
    yield {"scene": "all images", **rest, "largest_delta_e": None}


def cost(build: Callable[[], Cube]) -> Row:
    """Return the nodes, the file and the time of a build."""
    cube = build()
    nodes = cube.data.points.present.sum()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        size = path.stat().st_size
    return {
        "nodes": nodes,
        "node_share": nodes / cube.data.lattice.size,
        "megabytes": size / 1e6,
        "cpu_s": time_call(build, RUNS).cpu,
    }


def largest_difference(cube: Cube, complete: Cube, scene: Images) -> float:
    """Return the largest ΔE00 between the answers of a sparse and a complete cube under
    the lights.

    The colours are those of an image, as scenes read it: decoders of JPEG differ by a
    code value.
    """
    sensor = cube.data.sensor
    colours = np.concatenate(list(scene.colours(scene.paths[0], sensor)))
    sample = np.random.default_rng(0).permutation(colours)[:SAMPLE]
    spectra = [each.reflectance(sample) for each in (cube, complete)]
    lights = [light(name, sensor.observer, *sensor.range) for name in SCENE_LIGHTS]
    return np.max([delta_e_spectra(lamp, *spectra) for lamp in lights])


QUESTIONS = {"plans": plans, "front": front, "sparse": sparse}
