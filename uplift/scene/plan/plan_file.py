"""Plans as JSON files, which ``uplift build --plan`` and other tools read, and the commands that carry them out."""

import os
import shlex
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from uplift.common.arrays import StrPath
from uplift.common.errors import PlanFileError, unknown_name
from uplift.common.files import file_digest
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.spec_file import SpecFile, SpecModel, read_json, resolves
from uplift.common.text import format_value
from uplift.common.version import VERSION
from uplift.io.scene_colours import Images
from uplift.io.texture import Spectrum
from uplift.io.texture.colours import check_encoding
from uplift.lookup import Cube
from uplift.pipeline.build import build, problem_of
from uplift.pipeline.options import Options, recorded_options
from uplift.scene.plan.planning import Plan
from uplift.scene.plan.scene_file import SceneFile

FORMAT: Literal["uplift plan 1"] = "uplift plan 1"
HINT = "plan the scene again"
MAX_FILES = 10_000
SUFFIX = ".plan.json"
CUBE_KEYS = ("model", "coefficients", "warp", "dim", "axis")
"""Options of a build that a plan chooses."""
SCENE_KEYS = ("lights", "tolerance", "quantile", "encoding", "minimise", "limits")


def to_json(plan: Plan, path: Path) -> dict[str, Any]:
    """The choice of a plan, its wavelengths and command lines, and the Pareto front, as JSON values.

    ``path`` is the file to write them to: paths of textures and atlases are relative to its folder.
    """
    scene, chosen = plan.scene, plan.chosen
    return {
        "format": FORMAT,
        "uplift": VERSION,
        "scene": {
            "file": scene.path.name,
            **{key: getattr(scene, key) for key in SCENE_KEYS},
            "textures": _sources(scene.textures, path),
            "atlases": _sources(scene.atlases, path),
        },
        "name": chosen.name,
        "build": chosen.cube and asdict(chosen.cube),
        "cells": "sparse" if chosen.sparse else "whole",
        "texture": asdict(chosen.pixel),
        "rendering": _rendering_json(plan),
        "spectra": plan.spectra
        and [{"rgb": rgb.tolist(), "reflectance": row.tolist()} for rgb, row in zip(*plan.spectra, strict=True)],
        "error": {
            "predicted": asdict(chosen.error.worst) | asdict(chosen.error),
            "confirmed": asdict(plan.confirmed.worst) | asdict(plan.confirmed),
            "within": plan.within_tolerance,
            "without_spectra": plan.without_spectra.quantile,
            "expected_of_measurements": plan.expected_error,
        },
        "cost": chosen.cost._asdict(),
        "search": {"considered": plan.considered, "measured": len(plan.measured)},
        "front": [
            {"name": each.name, "rendering": each.traced, "pixel": asdict(each.pixel)}
            | {"cube": each.cube and {key: getattr(each.cube, key) for key in CUBE_KEYS}, "sparse": each.sparse}
            | {**each.cost._asdict(), "error": asdict(each.error.worst)}
            for each in plan.front
        ],
        "lines": list(commands(plan, path)),
    }


def _rendering_json(plan: Plan) -> dict[str, Any]:
    """Wavelengths and their weights, the name of a representation, or matrices of RGB."""
    if plan.chosen.rendering is None:
        return {"rgb_to_xyz": dict(zip(plan.scene.lights, plan.matrices.tolist(), strict=True))}
    if (sampling := plan.chosen.rendering.sampling) is None:
        return {"representation": plan.chosen.rendering.name}
    powers = dict(zip(sampling.lights, sampling.powers.tolist(), strict=True))
    return {"wavelengths": sampling.wavelengths.tolist(), "to_xyz": sampling.to_xyz.tolist(), "powers": powers}


def _sources(paths: Iterable[Path], plan: Path) -> list[dict[str, str]]:
    return [
        {"path": Path(os.path.relpath(path, plan.parent)).as_posix(), "digest": file_digest(path)} for path in paths
    ]


def cube_name(plan_path: StrPath) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


def commands(plan: Plan, path: Path) -> tuple[str, ...]:
    """Command lines for a plan at ``path``: its build, and its textures or the program that looks colours up."""
    scene, pixel = plan.scene, plan.chosen.pixel
    if plan.chosen.cube is None:
        return ()
    build, cube = f"uplift build --plan {shlex.quote(str(path))}", cube_name(path)
    if pixel.mode:
        return build, shlex.join(["uplift", "export", cube, "--format", "c", "--mode", pixel.mode])
    target = f"{scene.textures[0].stem}-uplifted.exr" if len(scene.textures) == 1 else "uplifted"
    words = ["uplift", "texture", *map(str, scene.textures), "-o", target, "--cube", cube]
    words += ["--representation", pixel.form, "--depth", pixel.depth]
    rendering = plan.chosen.rendering
    if pixel.form == Spectrum.name and rendering is not None and rendering.sampling is not None:
        words += ["--wavelengths", ",".join(f"{each:g}" for each in rendering.wavelengths)]
    if scene.encoding != SceneFile.encoding:
        words += ["--encoding", scene.encoding]
    return build, shlex.join(words)


@dataclass(frozen=True)
class PlanFile:
    """What a build needs of a plan: its unchanged sources, the ``options`` of the build, and whether it is sparse."""

    images: Images
    atlases: tuple[Path, ...]
    sparse: bool
    options: dict[str, Any]

    def build(self, *, debug: bool = False, progress: ProgressCallback = ignore_progress) -> Cube:
        """Build the planned cube, with the warnings and errors of `uplift.build`."""
        scene = self.images if self.sparse else None
        return build(self.atlases or None, scene=scene, progress=progress, **self.options | {"debug": debug})


class _Source(SpecModel):
    """A texture or an atlas with its SHA-256."""

    path: str
    digest: str


class _Scene(SpecModel):
    """Source files of a plan."""

    model_config = ConfigDict(extra="ignore")

    encoding: Annotated[str, resolves(check_encoding)]
    textures: Annotated[list[_Source], Field(min_length=1, max_length=MAX_FILES)]
    atlases: Annotated[list[_Source], Field(max_length=MAX_FILES)]


def _check_options(values: dict[str, Any]) -> None:
    """Raise `UpliftError` unless a build accepts the options."""
    known = [field.name for field in fields(Options)]
    for name in values:
        if name not in known:
            raise unknown_name(name, known, "option")
    options = Options(**recorded_options(values))
    problem_of(options, options.observer, options.solver)


class _PlanTable(SpecModel):
    """The keys of a plan file that a build needs."""

    model_config = ConfigDict(extra="ignore")

    format: Literal["uplift plan 1"]
    scene: _Scene
    build: Annotated[dict[str, Any], resolves(_check_options)] | None
    cells: Literal["sparse", "whole"]


def read_plan(path: StrPath) -> PlanFile:
    """Read a plan file that was written from `to_json`.

    Raises `PlanFileError` if it is not a valid plan, or a texture or an atlas is missing or has changed.
    """
    file = read_json(path, PlanFileError)
    table = file.validate(_PlanTable, hint=HINT)
    if table.build is None:
        file.fail(("build",), "the plan needs no cube", hint="render as its key 'rendering' describes")
    textures, atlases = (_check_sources(file, key, getattr(table.scene, key)) for key in ("textures", "atlases"))
    images = Images(textures, table.scene.encoding)
    return PlanFile(images, atlases, table.cells == "sparse", recorded_options(table.build))


def _check_sources(file: SpecFile, key: str, sources: list[_Source]) -> tuple[Path, ...]:
    paths = [file.path.parent / source.path for source in sources]
    for number, (source, path) in enumerate(zip(sources, paths, strict=True)):
        keys = "scene", key, number, "path"
        if not os.path.isfile(path):
            hint = f"restore it, or {HINT}"
            file.fail(keys, f"no file named {format_value(source.path)}", code="file-not-found", hint=hint)
        if file_digest(path) != source.digest:
            text = f"{format_value(source.path)} has changed since the plan was made"
            file.fail(keys, text, code="source-changed", hint=HINT)
    return tuple(paths)
