"""Scene plans for real images, checked by an independent computation, for docs/plan.md."""

import json
import os
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

import uplift
from benchmarks import ATLASES, DOCS, record
from benchmarks.pictures import pictures
from uplift import models
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.plan.context import ColourSet, SearchGrid

with warnings.catch_warnings(action="ignore"):  # about optional dependencies
    import colour

BIN = Path(sys.executable).parent
REFERENCE = ("--dim", "128", "--coefficients", "17")
ROWS = 1 << 15
"""Spectra per block."""


@dataclass(frozen=True)
class Case:
    """A picture, an atlas, lights and a tolerance."""

    picture: str
    atlas: str
    lights: tuple[str, ...]
    tolerance: float

    @property
    def stem(self) -> str:
        """Name of the scene file without its extension."""
        return f"{Path(self.picture).stem}-{self.tolerance:g}"

    def scene(self) -> str:
        """Return the text of the scene file."""
        return (
            f'textures = ["{self.picture}"]\natlases = ["{self.atlas}"]\n'
            f"lights = {json.dumps(self.lights)}\ntolerance = {self.tolerance}\n"
        )


Errors = dict[tuple[str, str], Array]
"""Independent ΔE00 by group and light."""


def check_plan(folder: Path, case: Case) -> tuple[dict[str, Any], float, Errors]:
    """Plan a scene, run the command lines of the plan, and compute the errors of what they write.

    Returns the content of the plan, the CPU seconds it took, and the errors.
    """
    shutil.copy(ATLASES / case.atlas, folder)
    stem = case.stem
    (folder / f"{stem}.toml").write_text(case.scene(), encoding="utf-8")
    begin = _cpu()
    _run(folder, f"uplift plan {stem}.toml --force")
    seconds = _cpu() - begin
    plan = json.loads((folder / f"{stem}.plan.json").read_text(encoding="utf-8"))
    build, texture = plan["lines"]
    _run(folder, f"{build} --force")
    _run(folder, f"{texture} --force")
    cube = uplift.load(folder / f"{stem}.uplift")
    planned = _pixel_values(folder / f"{Path(case.picture).stem}-uplifted.exr")
    expected = _pixel_values(_reference(folder, case))
    measured, answered = _materials(folder, case, plan)
    errors: Errors = {}
    for light in case.lights:
        blocks = [slice(first, first + ROWS) for first in range(0, len(planned), ROWS)]
        found = [
            _errors(expected[rows], _spectra(plan, cube.data.model, planned[rows]), plan, light) for rows in blocks
        ]
        errors["textures", light] = np.concatenate(found)
        errors["materials", light] = _errors(measured, answered, plan, light)
    return plan, seconds, errors


def _cpu() -> float:
    """Return the CPU seconds of all child processes so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _run(folder: Path, line: str) -> None:
    words = shlex.split(line)
    subprocess.run([str(BIN / words[0]), *words[1:]], cwd=folder, check=True, capture_output=True)


def _reference(folder: Path, case: Case) -> Path:
    """Return the texture by the reference cube at all wavelengths, written once per picture, atlas and lights."""
    stem = "-".join([Path(case.picture).stem, Path(case.atlas).stem, *case.lights])
    path = folder / f"reference-{stem}.exr"
    if not path.exists():
        # The same lights as the cube of the plan: the build illuminant and those of the scene.
        lights = " ".join(f"--light {name}" for name in dict.fromkeys(("D65", *case.lights)))
        words = f"--atlas {case.atlas} {lights} --scene {case.picture} {' '.join(REFERENCE)} -o {stem}.uplift"
        _run(folder, f"uplift build {words}")
        _run(folder, f"uplift texture {case.picture} -o {path.name} --cube {stem}.uplift --depth float")
    return path


def _materials(folder: Path, case: Case, plan: dict[str, Any]) -> tuple[Array, Array]:
    """Return the atlas entries, and the answers at the plan's wavelengths of a cube that has their nodes."""
    sensor = observer.sensor()
    measured = resample(read_atlas(folder / case.atlas), sensor.wavelengths).values
    measured = measured[sensor.contains(sensor.rgb(measured))]
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    with warnings.catch_warnings(action="ignore", category=uplift.UpliftWarning):
        options = {**plan["build"], "lights": tuple(plan["build"]["lights"])}
        cube = uplift.build(folder / case.atlas, scene=ColourSet(rgb), **options)
    return measured, cube.reflectance(rgb, plan["rendering"]["wavelengths"])


def _pixel_values(path: Path) -> Array:
    """Return all channels of a texture except RGB, (pixels, N)."""
    channels = OpenEXR.File(os.fspath(path), separate_channels=True).channels()
    names = sorted(name for name in channels if name.startswith(("T.", "moment.", "multiplier.")))
    return np.stack([channels[name].pixels.ravel() for name in names], axis=-1)


def _spectra(plan: dict[str, Any], model: models.Model, values: Array) -> Array:
    """Return reflectances at the wavelengths of the plan."""
    wavelengths, numbers = plan["rendering"]["wavelengths"], values.astype(float)
    if plan["texture"]["form"] == "spectrum":
        return numbers
    evaluate = models.reflectance if plan["texture"]["form"] == "moments" else models.evaluate
    return evaluate(model, numbers, wavelengths)


def _integrated(reflectances: Array, light: str) -> Array:
    """Return XYZ (n, 3) by colour-science; white has Y = 1."""
    shape = colour.SpectralShape(380, 780, 5)
    cmfs = colour.MSDS_CMFS[observer.DEFAULT_OBSERVER].copy().align(shape)
    illuminant = colour.SDS_ILLUMINANTS[light].copy().align(shape)
    xyz = colour.colorimetry.msds_to_XYZ_integration(
        reflectances.astype(float), cmfs=cmfs, illuminant=illuminant, shape=shape
    )
    return np.asarray(xyz) / 100


def _errors(expected: Array, answered: Array, plan: dict[str, Any], light: str) -> Array:
    """Return ΔE00 (n,) by colour-science of reflectances (n, W) at the plan's wavelengths, rendered by its weights."""
    rendering = plan["rendering"]
    rendered = (answered * np.array(rendering["powers"][light])) @ np.array(rendering["to_xyz"])
    white = colour.XYZ_to_xy(_integrated(np.ones((1, 81)), light)[0])
    labs = [colour.XYZ_to_Lab(xyz, white) for xyz in (_integrated(expected, light), rendered)]
    return np.asarray(colour.delta_E(*labs, method="CIE 2000"))


PICTURE = DOCS / "plan" / "page.png"
CASES = (
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 1.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 2.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 0.5),
    Case("coffee.png", "macbeth.txt", ("D65", "A", "FL2", "FL11", "LED-B3"), 1.0),
    Case("chelsea.png", "babelcolor.txt", ("D50", "FL11"), 1.0),
)
"""The decisions of the first case are shown."""


def main() -> None:
    """Plan, check and store."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for picture in pictures():
            shutil.copy(picture.path, folder)
        checked = [check_plan(folder, case) for case in CASES]
        _screenshot(folder / f"{CASES[0].stem}.plan.html")
    effort = SearchGrid()
    record(
        "plan",
        precision="full",
        predicting=effort.predicting,
        confirming=effort.confirming,
        reference_dim=effort.reference,
        reference_coefficients=effort.coefficients[-1],
        scenes=[summary(case, *each) for case, each in zip(CASES, checked, strict=True)],
        decisions=[candidates(decision) for decision in checked[0][0]["decisions"]],
    )


def summary(case: Case, plan: dict[str, Any], seconds: float, errors: Errors) -> dict[str, Any]:
    """Return what a plan chose, its predicted error, and the independent one."""
    error, quantile = plan["error"], plan["scene"]["quantile"]
    independent = {key: float(np.quantile(values, quantile, method="inverted_cdf")) for key, values in errors.items()}
    group, light = max(independent, key=lambda key: independent[key])
    predicted, largest = error["predicted"]["quantile"], max(independent.values())
    build, texture = plan["build"], plan["texture"]
    return {
        "texture": case.picture,
        "atlas": case.atlas,
        "lights": case.lights,
        "tolerance": case.tolerance,
        "cube": f"{build['dim']}³ × {build['coefficients']}, {plan['cells']}",
        "wavelengths": len(plan["rendering"]["wavelengths"]),
        "pixel": f"{texture['form']}, {texture['depth']}",
        "predicted": predicted,
        "confirmed": error["confirmed"]["quantile"],
        "independent": largest,
        "deviation": largest / predicted - 1,
        "group": group,
        "light": light,
        "seconds": seconds,
    }


def candidates(decision: dict[str, Any]) -> dict[str, Any]:
    """Return the candidates of a decision with their errors."""
    keys = ("quantile", "mean", "largest", "group", "light")
    trials = [
        {"name": trial["name"], "cost": trial["told"], **{key: trial["error"][key] for key in keys}}
        | {"chosen": number == decision["taken"]}
        for number, trial in enumerate(decision["trials"])
    ]
    return {"title": decision["title"], "limit": decision["limit"], "trials": trials}


def _screenshot(page: Path) -> None:
    """Take a picture of the page of a plan if Chromium is installed."""
    if browser := shutil.which("chromium"):
        PICTURE.parent.mkdir(exist_ok=True)
        words = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--screenshot={PICTURE}"]
        subprocess.run([browser, *words, "--window-size=1180,1500", page.as_uri()], check=True, capture_output=True)
