"""Plans as JSON files, which ``uplift build --plan`` and other tools read, and the commands that carry them out."""

import os
import shlex
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from uplift.colorimetry import observer
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
from uplift.pipeline.build import build
from uplift.pipeline.options import Options, recorded_options
from uplift.scene.plan.decisions import wavelength_args
from uplift.scene.plan.evaluation import Decision
from uplift.scene.plan.planning import Plan
from uplift.scene.plan.scene_file import SceneFile

FORMAT: Literal["uplift plan 1"] = "uplift plan 1"
HINT = "plan the scene again"
MAX_FILES = 10_000
SUFFIX = ".plan.json"


def to_json(plan: Plan, path: Path) -> dict[str, Any]:
    """All decisions of a plan with their measurements, its wavelengths and its command lines, as JSON values.

    ``path`` is the file to write them to: paths of textures and atlases are relative to its folder.
    """
    scene, final = plan.scene, plan.final_build
    # All options in JSON values, so that later defaults do not change the build.
    options = {
        key: list(each) if isinstance(each, tuple) else each for key, each in asdict(Options(**plan.options)).items()
    }
    return {
        "format": FORMAT,
        "uplift": VERSION,
        "scene": {
            "file": scene.path.name,
            "lights": list(scene.lights),
            "tolerance": scene.tolerance,
            "quantile": scene.quantile,
            "encoding": scene.encoding,
            "textures": _sources(scene.textures, path),
            "atlases": _sources(scene.atlases, path),
        },
        "build": options,
        "cells": "sparse" if final.is_sparse else "whole",
        "texture": asdict(plan.storage),
        "rendering": {
            "wavelengths": plan.sampling.wavelengths.tolist(),
            "to_xyz": plan.sampling.to_xyz.tolist(),
            "powers": dict(zip(plan.sampling.lights, plan.sampling.powers.tolist(), strict=True)),
        },
        "error": {
            **{
                name: {**asdict(error.worst), "parts": [asdict(part) for part in error.parts]}
                for name, error in (("predicted", plan.predicted), ("confirmed", plan.confirmed))
            },
            "within": plan.within_tolerance,
            "expected_of_measurements": plan.expected_error,
        },
        "cost": {
            "points": final.points,
            "bytes": final.size,
            "cpu_seconds": final.seconds,
            "bytes_whole": final.full_size,
            "bytes_sparse": final.sparse_size,
        },
        "decisions": [_decision_json(each) for each in plan.decisions],
        "lines": list(commands(plan, path)),
    }


def _sources(paths: Iterable[Path], plan: Path) -> list[dict[str, str]]:
    return [
        {"path": Path(os.path.relpath(path, plan.parent)).as_posix(), "digest": file_digest(path)} for path in paths
    ]


def _decision_json(decision: Decision) -> dict[str, Any]:
    trials = [
        {
            "name": trial.name,
            "cost": trial.cost,
            "told": trial.cost_text,
            "typed": trial.cli_args,
            "choice": trial.choice,
            "error": asdict(trial.error.worst),
        }
        for trial in decision.trials
    ]
    header = {name: getattr(decision, name) for name in ("key", "title", "unit", "limit")}
    return {**header, "trials": trials, "taken": decision.selected, "kept": decision.within_limit}


def cube_name(plan_path: StrPath) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


def commands(plan: Plan, path: Path) -> tuple[str, str]:
    """Command lines for a plan at ``path``: its build, and all its textures."""
    scene, storage = plan.scene, plan.storage
    target = f"{scene.textures[0].stem}-uplifted.exr" if len(scene.textures) == 1 else "uplifted"
    words = [*map(str, scene.textures), "-o", target, "--cube", cube_name(path), *storage.cli_args.split()]
    if storage.form == Spectrum.name:
        words += wavelength_args(plan.sampling.wavelengths).split()
    if scene.encoding != SceneFile.encoding:
        words += ["--encoding", scene.encoding]
    return f"uplift build --plan {shlex.quote(str(path))}", f"uplift texture {shlex.join(words)}"


@dataclass(frozen=True)
class PlanFile:
    """What a build needs of a plan: its unchanged sources, the ``options`` of the build, and whether it is sparse."""

    path: Path
    textures: tuple[Path, ...]
    atlases: tuple[Path, ...]
    encoding: str
    sparse: bool
    options: dict[str, Any]

    def build(self, *, debug: bool = False, progress: ProgressCallback = ignore_progress) -> Cube:
        """Build the planned cube, with the warnings and errors of `uplift.build`."""
        scene = Images(self.textures, self.encoding) if self.sparse else None
        options = {**self.options, "debug": debug}
        return build(self.atlases or None, scene=scene, progress=progress, **options)


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
    observer.sensor(options.space, options.illuminant, options.observer)
    for name in options.lights:
        observer.light(name, options.observer)


class _PlanTable(SpecModel):
    """The keys of a plan file that a build needs."""

    model_config = ConfigDict(extra="ignore")

    format: Literal["uplift plan 1"]
    scene: _Scene
    build: Annotated[dict[str, Any], resolves(_check_options)]
    cells: Literal["sparse", "whole"]


def read_plan(path: StrPath) -> PlanFile:
    """Read a plan file that was written from `to_json`.

    Raises `PlanFileError` if it is not a valid plan, or a texture or an atlas is missing or has changed.
    """
    file = read_json(path, PlanFileError)
    table = file.validate(_PlanTable, hint=HINT)
    textures, atlases = (_check_sources(file, key, getattr(table.scene, key)) for key in ("textures", "atlases"))
    return PlanFile(
        file.path, textures, atlases, table.scene.encoding, table.cells == "sparse", recorded_options(table.build)
    )


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
