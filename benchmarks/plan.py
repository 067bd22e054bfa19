"""Sparse cubes for real images, and plans for these and the sample kitchen, for
docs/plan.md and its picture.
"""

import json
import shlex
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, replace
from functools import partial
from itertools import starmap
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ATLASES, DOCS, MACBETH, Row, record
from benchmarks.performance import UPLIFT
from benchmarks.pictures import Picture, pictures
from uplift.colorimetry import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.observer import light
from uplift.extras.pages.figure import ACCENT, INK, write_figure
from uplift.extras.pages.format import format_size
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Axis, Dot, draw
from uplift.extras.pages.pareto import front_panel
from uplift.extras.scene.plan.candidates import SearchGrid
from uplift.extras.scene.plan.space import CEILING, FLOOR, MARGIN
from uplift.extras.texture.scene_colours import MAX_LIST, MAX_PIXELS, Images
from uplift.lab.timing import TimingStats, children_cpu, time_calls
from uplift.lookup import Cube
from uplift.samples import copy_samples

LATTICES = (("sRGB", 32), ("sRGB", 64), ("sRGB", 128), ("ACEScg", 32))
RUNS = 3
SAMPLE = 20_000
"""Colours of an image at which complete and sparse cubes are compared."""
Measured = tuple[Cube, TimingStats, int]
"""A cube, the CPU seconds of its build, and the bytes of its file."""
PICTURE = DOCS / "plan" / "front.png"
KITCHEN = ("still-life.png", "wood.png")
TWO = ("D65", "FL11")
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
    Case(("astronaut.png",), "macbeth.txt", TWO, 1.0),
    Case(("astronaut.png",), "macbeth.txt", TWO, 0.5, quick=False),
    Case(("coffee.png",), "macbeth.txt", FIVE, 1.0),
    Case(("chelsea.png",), "babelcolor.txt", ("D50", "FL11"), 1.0),
    Case(("china.jpg",), "", TWO, 1.0),
    Case(("rocket.jpg",), "", FIVE, 1.0),
    Case(("chelsea.png",), "", ("D65", "D55"), 1.0),
)
"""The front of the first case is shown."""


def main() -> None:
    """Measure sparse cubes and plans, and store."""
    sparse_cubes()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_samples(folder)
        sources = [picture.path for picture in pictures()]
        for source in (*sources, MACBETH, ATLASES / "babelcolor.txt"):
            shutil.copy(source, folder)
        scenes, plans = zip(*(run(folder, case) for case in CASES), strict=True)
    draw_front(plans[0])
    grid = SearchGrid()
    record(
        "plan",
        predicting=grid.predicting,
        confirming=grid.confirming,
        reference_dim=grid.reference,
        reference_coefficients=grid.models["none"][-1],
        margin=MARGIN,
        floor=FLOOR,
        ceiling=CEILING,
        colours=MAX_LIST,
        pixels=MAX_PIXELS,
        scenes=scenes,
    )


def run(folder: Path, case: Case) -> tuple[Row, Row]:
    """Plan a scene; return the figures of the page, and the plan."""
    (folder / "scene.toml").write_text(case.scene(), encoding="utf-8")
    line = f"plan scene.toml --force {'--quick' if case.quick else ''}"
    seconds = children_cpu(partial(call, folder, line))
    plan = json.loads((folder / "scene.plan.json").read_text(encoding="utf-8"))
    size = None
    if plan["build"]:
        call(folder, "build --plan scene.plan.json -o scene.uplift --force")
        size = (folder / "scene.uplift").stat().st_size
    error = plan["error"]
    return {
        "textures": case.pictures,
        "lights": case.lights,
        "tolerance": case.tolerance,
        "choice": plan["name"],
        "predicted": error["predicted"]["quantile"],
        "confirmed": error["confirmed"]["quantile"],
        "rgb": error["without_spectra"],
        "expected": error["expected_of_measurements"],
        "bytes": size,
        **plan["search"],
        "seconds": seconds,
    }, plan


def call(folder: Path, line: str) -> None:
    """Run a command of this package."""
    subprocess.run(
        [UPLIFT, *shlex.split(line)], cwd=folder, check=True, capture_output=True
    )


def draw_front(plan: Row) -> None:
    """Draw error over memory and over samples for the front of a plan."""
    axes = {
        "memory": Axis("cube file and pixels", log=True, text=format_size),
        "samples": Axis("samples per ray", log=True),
    }
    panels = []
    for key, axis in axes.items():
        dots = []
        for candidate in plan["front"]:
            name = candidate["name"]
            colour, marker = (ACCENT, "D") if name == plan["name"] else (INK, "o")
            error = candidate["error"]["quantile"]
            dots.append(Dot(candidate[key], error, name, colour, marker))
        panels.append(front_panel(f"ΔE00 over {key}", axis, [], dots))
    chosen = line([], [], "chosen", ACCENT, marker="D", linestyle="")
    panels[0] = replace(panels[0], marks=[*panels[0].marks, chosen])
    PICTURE.parent.mkdir(exist_ok=True)
    write_figure(draw(panels, 2, (4.8, 3.4), legend="below"), PICTURE, force=True)


def sparse_cubes() -> None:
    """Measure sparse cubes and store."""
    images = list(pictures())
    uplift.build(MACBETH, dim=32)  # compile before timing
    sections = starmap(partial(measure, images), LATTICES)
    record("plan", "scenes", runs=RUNS, sections=sections)


def measure(images: list[Picture], space: str, dim: int) -> Row:
    """Compare the complete cube with sparse cubes for each image and for all images."""
    complete = build(space, dim, [])
    rows = [compare("complete cube", complete, complete)]
    for picture in images:
        sparse = build(space, dim, [picture])
        name = f"{picture.path.name} ({picture.package})"
        difference = largest_difference(sparse[0], complete[0], picture)
        rows.append(compare(name, sparse, complete) | {"largest_delta_e": difference})
    rows.append(compare("all images", build(space, dim, images), complete))
    return {
        "space": space,
        "dim": dim,
        "nodes": complete[0].data.lattice.size,
        "rows": rows,
    }


def build(space: str, dim: int, scene: list[Picture]) -> Measured:
    """Build a cube for images, or a complete one."""
    images = Images(tuple(picture.path for picture in scene)) if scene else None
    timed = partial(uplift.build, MACBETH, dim=dim, space=space, scene=images)
    cubes = []
    _, cpu = time_calls(lambda: cubes.append(timed()), RUNS)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cubes[-1].save(path)
        return cubes[-1], cpu, path.stat().st_size


def compare(name: str, sparse: Measured, complete: Measured) -> Row:
    """Compare nodes, size and time; differences of answers are unknown."""
    cube, seconds, size = sparse
    all_nodes, all_seconds, all_size = complete
    nodes = cube.data.points.present.sum()
    return {
        "scene": name,
        "nodes": nodes,
        "node_share": nodes / all_nodes.data.lattice.size,
        "megabytes": size / 1e6,
        "size_share": size / all_size,
        "seconds": seconds,
        "time_share": seconds.median / all_seconds.median,
        "largest_delta_e": None,
    }


def largest_difference(sparse: Cube, complete: Cube, picture: Picture) -> float:
    """Return the largest ΔE00 between the answers of two cubes under the lights.

    The colours are those of an image, as scenes read it: decoders of JPEG differ by a
    code value.
    """
    sensor = sparse.data.sensor
    images = Images((picture.path,))
    colours = np.concatenate(list(images.colours(picture.path, sensor)))
    sample = np.random.default_rng(0).permutation(colours)[:SAMPLE]
    spectra = [cube.reflectance(sample) for cube in (sparse, complete)]
    lights = [light(name, sensor.observer, *sensor.range) for name in SCENE_LIGHTS]
    return np.max([delta_e_spectra(lamp, *spectra) for lamp in lights])
