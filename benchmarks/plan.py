"""Sparse cubes for real images, and plans for these and the sample kitchen, for
docs/plan.md.
"""

import json
import shutil
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import uplift
from benchmarks import MACBETH, UPLIFT, Row
from benchmarks.pictures import pictures
from benchmarks.timing import run_command, time_call
from uplift.extras.texture.scene_colours import Images
from uplift.lookup.cube import Cube
from uplift.samples import copy_samples

DIM = 64
RUNS = 3
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


def plans() -> Iterator[Row]:
    """Yield the chosen candidates, their errors and the cost of the search."""
    for case in CASES:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            copy_samples(folder)
            for source in (*(picture.path for picture in pictures()), MACBETH):
                shutil.copy(source, folder)
            (folder / "scene.toml").write_text(case.scene(), encoding="utf-8")
            plan = [UPLIFT, "plan", "scene.toml"] + ["--quick"] * case.quick
            run = run_command(plan, folder=folder)
            found = json.loads((folder / "scene.plan.json").read_text(encoding="utf-8"))
            size = None
            if found["build"]:
                build = [UPLIFT, "build", "--plan", "scene.plan.json"]
                build += ["-o", "scene.uplift"]
                run_command(build, folder=folder)
                size = (folder / "scene.uplift").stat().st_size
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
            "cpu_s": run.cpu,
        }


def sparse() -> Iterator[Row]:
    """Yield nodes, size and CPU seconds of the complete cube, and of those for
    images.
    """
    build = partial(uplift.build, MACBETH, dim=DIM)
    yield {"scene": "complete cube", **cost(build)}
    paths = [picture.path for picture in pictures()]
    for path in paths:
        yield {"scene": path.name, **cost(partial(build, scene=Images((path,))))}
    everything = partial(build, scene=Images(tuple(paths)))
    yield {"scene": "all images", **cost(everything)}


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


QUESTIONS = {"plans": plans, "sparse": sparse}
