"""Scene plans for the sample kitchen and for real images, for docs/plan.md and its picture."""

import json
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks import ATLASES, DOCS, record
from benchmarks.pictures import pictures
from uplift.io.scene_colours import MAX_LIST, MAX_PIXELS
from uplift.lab.panels import Panel, Point, write_panels
from uplift.samples import copy_samples
from uplift.scene.plan.candidates import SearchGrid
from uplift.scene.plan.space import CEILING, FLOOR, MARGIN
from uplift.viz.figure import ACCENT, INK
from uplift.viz.format import format_size

BIN = Path(sys.executable).parent
PICTURE = DOCS / "plan" / "front.png"
TWO = ("D65", "FL11")
FIVE = ("D65", "A", "FL2", "FL11", "LED-B3")


@dataclass(frozen=True)
class Case:
    """Pictures, an atlas or none, lights and a tolerance, and what version 0.2.0 chose for them."""

    pictures: tuple[str, ...]
    atlas: str
    lights: tuple[str, ...]
    tolerance: float
    before: tuple[int, int, bool, int] | None = None
    """Nodes along an axis, coefficients, whether sparse, and wavelengths."""
    quick: bool = True

    def scene(self) -> str:
        """Return the text of the scene file."""
        atlas = f'atlases = "{self.atlas}"\n' if self.atlas else ""
        textures, lights = json.dumps(self.pictures), json.dumps(self.lights)
        return f"textures = {textures}\n{atlas}lights = {lights}\ntolerance = {self.tolerance}\n"

    def options_before(self) -> str:
        """Return the options of the cube that 0.2.0 chose."""
        dim, count, sparse, _ = self.before
        lights = [f"--light {name}" for name in dict.fromkeys(("D65", *self.lights))]
        scene = [f"--scene {name}" for name in self.pictures if sparse]
        return f"--atlas {self.atlas} {' '.join(lights + scene)} --dim {dim} --coefficients {count}"


CASES = (
    Case(("still-life.png", "wood.png"), "paints.csv", ("D65", "A", "FL11"), 1.0, (24, 13, False, 7), quick=False),
    Case(("still-life.png", "wood.png"), "paints.csv", ("FL11", "HP1", "LED-RGB1"), 0.15, quick=False),
    Case(("astronaut.png",), "macbeth.txt", TWO, 1.0, (48, 13, True, 7)),
    Case(("astronaut.png",), "macbeth.txt", TWO, 0.5, (64, 15, True, 9), quick=False),
    Case(("coffee.png",), "macbeth.txt", FIVE, 1.0, (128, 15, True, 9)),
    Case(("chelsea.png",), "babelcolor.txt", ("D50", "FL11"), 1.0, (32, 9, True, 7)),
    Case(("china.jpg",), "", TWO, 1.0),
    Case(("rocket.jpg",), "", FIVE, 1.0),
    Case(("chelsea.png",), "", ("D65", "D55"), 1.0),
)
"""The front of the first case is shown."""
LIMITS = {"margin": MARGIN, "floor": FLOOR, "ceiling": CEILING, "colours": MAX_LIST, "pixels": MAX_PIXELS}


def main() -> None:
    """Plan and store."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_samples(folder)
        for source in [picture.path for picture in pictures()] + [ATLASES / "macbeth.txt", ATLASES / "babelcolor.txt"]:
            shutil.copy(source, folder)
        scenes, plans = zip(*(run(folder, case) for case in CASES), strict=True)
    draw(plans[0])
    grid = SearchGrid()
    record(
        "plan",
        predicting=grid.predicting,
        confirming=grid.confirming,
        reference_dim=grid.reference,
        reference_coefficients=grid.models["none"][-1],
        **LIMITS,
        scenes=scenes,
    )


def run(folder: Path, case: Case) -> tuple[dict[str, Any], dict[str, Any]]:
    """Plan a scene; return the figures of the page, and the plan."""
    (folder / "scene.toml").write_text(case.scene(), encoding="utf-8")
    begin = cpu()
    call(folder, f"uplift plan scene.toml --force {'--quick' if case.quick else ''}")
    seconds = cpu() - begin
    plan = json.loads((folder / "scene.plan.json").read_text(encoding="utf-8"))
    size = built_bytes(folder, "--plan scene.plan.json") if plan["build"] else None
    before = built_bytes(folder, case.options_before()) if case.before else None
    error = plan["error"]
    return {
        "textures": case.pictures,
        "atlas": case.atlas or "none",
        "lights": case.lights,
        "tolerance": case.tolerance,
        "search": "quick" if case.quick else "full",
        "choice": plan["name"],
        "predicted": error["predicted"]["quantile"],
        "confirmed": error["confirmed"]["quantile"],
        "rgb": error["without_spectra"],
        "expected": error["expected_of_measurements"],
        "bytes": size,
        "before": before,
        "share": size / before if size and before else None,
        "samples": plan["cost"]["samples"],
        "samples_before": case.before[-1] if case.before else None,
        "front": len(plan["front"]),
        **plan["search"],
        "seconds": seconds,
    }, plan


def built_bytes(folder: Path, options: str) -> int:
    """Return the bytes of the cube file that is built with these options."""
    call(folder, f"uplift build {options} -o built.uplift --force")
    return (folder / "built.uplift").stat().st_size


def cpu() -> float:
    """Return the CPU seconds of all child processes so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def call(folder: Path, line: str) -> None:
    """Run a command of this package."""
    words = shlex.split(line)
    subprocess.run([str(BIN / words[0]), *words[1:]], cwd=folder, check=True, capture_output=True)


def draw(plan: dict[str, Any]) -> None:
    """Draw error over memory and over samples for the front of a plan."""
    axes = {"memory": ("cube file and pixels", format_size), "samples": ("samples per ray", "{:g}".format)}
    styles = {True: (ACCENT, "D"), False: (INK, "o")}

    def point(row: int, each: dict[str, Any], key: str) -> Point:
        style = styles[each["name"] == plan["name"]]
        return Point(row, each["name"], each[key], each["error"]["quantile"], *style, named=False)

    panels = [
        Panel(f"ΔE00 over {key}", title, text, [point(*each, key) for each in enumerate(plan["front"])])
        for key, (title, text) in axes.items()
    ]
    PICTURE.parent.mkdir(exist_ok=True)
    legend = {"on the front": {"color": INK}, "chosen": {"color": ACCENT, "marker": "D"}}
    write_panels(panels, 2, PICTURE, legend, force=True)
