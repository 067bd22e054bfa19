"""The independent computation: a plan's own lines as processes, textures read by OpenEXR, seen by colour-science."""

from __future__ import annotations

import json
import os
import resource
import shlex
import shutil
import subprocess
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

import uplift
from benchmarks.timing import ROOT
from uplift import models
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.plan.colours import ColourSet

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of its optional parts
    import colour

BIN = Path(sys.executable).parent
BEST = ("--dim", "128", "--moments", "16")
ROWS = 1 << 15
"""Spectra seen at a time."""


@dataclass(frozen=True)
class Case:
    """A picture, an atlas, lights, a tolerance."""

    picture: str
    atlas: str
    lights: tuple[str, ...]
    tolerance: float

    def scene(self) -> str:
        return (
            f'textures = ["{self.picture}"]\natlases = ["{self.atlas}"]\n'
            f"lights = {json.dumps(self.lights)}\ntolerance = {self.tolerance}\n"
        )


@dataclass(frozen=True, eq=False)
class Found:
    """A plan as its file has it, CPU seconds it took, and ΔE00 by the independent computation, by group and light."""

    case: Case
    plan: dict[str, Any]
    seconds: float
    apart: dict[tuple[str, str], Array]


def found(folder: Path, case: Case) -> Found:
    shutil.copy(ROOT / "atlases" / case.atlas, folder)
    stem = f"{Path(case.picture).stem}-{case.tolerance:g}"
    (folder / f"{stem}.toml").write_text(case.scene(), encoding="utf-8")
    begin = _cpu()
    _run(folder, f"uplift plan {stem}.toml --force")
    seconds = _cpu() - begin
    plan = json.loads((folder / f"{stem}.plan.json").read_text(encoding="utf-8"))
    print(f"{stem}: planned in {seconds:.0f} s of CPU time", file=sys.stderr)
    build, _, texture = plan["lines"]
    _run(folder, f"{build} --force")
    _run(folder, f"{texture} --force")
    best = _best(folder, case)
    apart = dict(_pixels(folder, case, plan, best)) | dict(_materials(folder, case, plan))
    return Found(case, plan, seconds, apart)


def _cpu() -> float:
    """CPU seconds of all processes that have been run."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _run(folder: Path, line: str) -> None:
    words = shlex.split(line)
    quiet = {"cwd": folder, "check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([str(BIN / words[0]), *words[1:]], **quiet)


def _best(folder: Path, case: Case) -> Path:
    """The texture of the best cube, at all wavelengths; made once for the same picture, atlas and lights."""
    stem = "-".join([Path(case.picture).stem, Path(case.atlas).stem, *case.lights])
    path = folder / f"best-{stem}.exr"
    if not path.exists():
        # The cube's lights are those of the plan's cube: the build illuminant and the scene's.
        lights = " ".join(f"--light {name}" for name in dict.fromkeys(("D65", *case.lights)))
        words = f"--atlas {case.atlas} {lights} --scene {case.picture} {' '.join(BEST)} -o {stem}.uplift"
        _run(folder, f"uplift build {words}")
        _run(folder, f"uplift texture {case.picture} {path.name} --cube {stem}.uplift --depth float")
    return path


def _pixels(
    folder: Path, case: Case, plan: dict[str, Any], best: Path
) -> Iterator[tuple[tuple[str, str], Array]]:
    stem = Path(case.picture).stem
    planned, wanted = _held(folder / f"{stem}-uplifted.exr"), _held(best)
    cube = uplift.load(folder / f"{stem}-{case.tolerance:g}.uplift")
    for light in case.lights:
        blocks = []
        for first in range(0, len(planned), ROWS):
            rows = slice(first, first + ROWS)
            seen = _rendered(_spectra(plan, cube.data.model, planned[rows]), plan, light)
            blocks.append(_difference(_integrated(wanted[rows], light), seen, light))
        yield ("textures", light), np.concatenate(blocks)


def _materials(folder: Path, case: Case, plan: dict[str, Any]) -> Iterator[tuple[tuple[str, str], Array]]:
    """The atlas's entries, asked of a cube of the same options that has their points."""
    sensor = observer.sensor()
    measured = resample(read_atlas(folder / case.atlas), sensor.wavelengths).values
    rgb = sensor.rgb(measured)
    measured, rgb = measured[sensor.contains(rgb)], np.clip(rgb[sensor.contains(rgb)], 0, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        options = {**plan["build"], "lights": tuple(plan["build"]["lights"])}
        cube = uplift.build(folder / case.atlas, scene=ColourSet(rgb), **options)
    answered = cube.reflectance(rgb, plan["rendering"]["wavelengths"])
    for light in case.lights:
        seen = _rendered(answered, plan, light)
        yield ("materials", light), _difference(_integrated(measured, light), seen, light)


def _held(path: Path) -> Array:
    """(pixels, N) numbers of a texture but for its RGB, as OpenEXR reads them."""
    channels = OpenEXR.File(os.fspath(path), separate_channels=True).channels()
    names = sorted(name for name in channels if name.startswith(("T.", "moment.", "multiplier.")))
    return np.stack([channels[name].pixels.ravel() for name in names], axis=-1)


def _spectra(plan: dict[str, Any], model: models.Model, held: Array) -> Array:
    """Reflectances at the plan's wavelengths."""
    at, numbers = plan["rendering"]["wavelengths"], held.astype(float)
    if plan["texture"]["form"] == "spectrum":
        return numbers
    made = models.reflectance if plan["texture"]["form"] == "moments" else models.evaluate
    return made(model, numbers, at)


def _rendered(reflectances: Array, plan: dict[str, Any], light: str) -> Array:
    """XYZ (n, 3): light by wavelength times reflectance, summed with the weights."""
    rendering = plan["rendering"]
    radiance = reflectances * np.array(rendering["powers"][light])
    return radiance @ np.array(rendering["to_xyz"])


def _integrated(reflectances: Array, light: str) -> Array:
    """XYZ (n, 3) by colour-science, white at Y = 1."""
    shape = colour.SpectralShape(380, 780, 5)
    cmfs = colour.MSDS_CMFS[observer.DEFAULT_OBSERVER].copy().align(shape)
    illuminant = colour.SDS_ILLUMINANTS[light].copy().align(shape)
    found = colour.colorimetry.msds_to_XYZ_integration(
        reflectances.astype(float), cmfs=cmfs, illuminant=illuminant, shape=shape
    )
    return np.asarray(found) / 100


def _difference(wanted: Array, seen: Array, light: str) -> Array:
    """ΔE00 (n,) by colour-science."""
    white = colour.XYZ_to_xy(_integrated(np.ones((1, 81)), light)[0])
    return np.asarray(
        colour.delta_E(*(colour.XYZ_to_Lab(xyz, white) for xyz in (wanted, seen)), method="CIE 2000")
    )
