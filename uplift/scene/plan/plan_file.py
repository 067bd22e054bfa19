"""A plan as a JSON file, for people, for other tools, and for ``uplift build --plan``."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from uplift.common.errors import PlanFileError, UpliftError
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.io.scene_colours import Images, file_digest
from uplift.lookup import Cube
from uplift.pipeline import build
from uplift.pipeline.options import Options
from uplift.scene.plan.commands import build_command, expanded_command, texture_command
from uplift.scene.plan.decision import Decision, Trial
from uplift.scene.plan.evaluation import ErrorSummary
from uplift.scene.plan.planning import Plan

FORMAT = "uplift plan 1"
AGAIN = "plan again: uplift plan SCENE.toml"


def to_json(plan: Plan, path: Path) -> dict[str, Any]:
    """All of a plan in JSON values; paths are relative to the folder of ``path``, where it is to be written."""
    scene, made = plan.scene, plan.final_build
    return {
        "format": FORMAT,
        "uplift": version("uplift"),
        "scene": {
            "file": scene.path.name,
            "lights": list(scene.lights),
            "tolerance": scene.tolerance,
            "quantile": scene.quantile,
            "encoding": scene.encoding,
            "textures": _sources(scene.textures, path),
            "atlases": _sources(scene.atlases, path),
        },
        "build": {**plan.options, "lights": list(plan.options["lights"])},
        "cells": "sparse" if made.is_sparse else "whole",
        "texture": asdict(plan.storage),
        "rendering": {
            "wavelengths": plan.sampling.wavelengths.tolist(),
            "to_xyz": plan.sampling.to_xyz.tolist(),
            "powers": dict(zip(plan.sampling.lights, plan.sampling.powers.tolist(), strict=True)),
        },
        "error": {
            "predicted": _error(plan.predicted),
            "confirmed": _error(plan.confirmed),
            "within": plan.within_tolerance,
            "expected_of_measurements": plan.expected_error,
        },
        "cost": {
            "points": made.points,
            "bytes": made.size,
            "cpu_seconds": made.seconds,
            "bytes_whole": made.whole,
            "bytes_sparse": made.sparse,
        },
        "decisions": [_decision(each) for each in plan.decisions],
        "lines": [build_command(path), expanded_command(plan, path), texture_command(plan, path)],
    }


def _sources(paths: Iterable[Path], plan: Path) -> list[dict[str, str]]:
    return [
        {"path": Path(os.path.relpath(path, plan.parent)).as_posix(), "digest": file_digest(path)}
        for path in paths
    ]


def _error(error: ErrorSummary) -> dict[str, Any]:
    return {**asdict(error.worst), "parts": [asdict(part) for part in error.parts]}


def _decision(decision: Decision) -> dict[str, Any]:
    trials = [_trial(trial) for trial in decision.trials]
    return {**asdict(decision), "trials": trials, "kept": decision.kept}


def _trial(trial: Trial) -> dict[str, Any]:
    return {**asdict(trial), "error": asdict(trial.error.worst)}


@dataclass(frozen=True)
class PlanFile:
    """What a plan's file says to build; all of it is as it was when the plan was measured."""

    path: Path
    textures: tuple[Path, ...]
    atlases: tuple[Path, ...]
    encoding: str
    sparse: bool
    options: dict[str, Any]

    def build(self, *, debug: bool = False, progress: ProgressCallback = ignore_progress) -> Cube:
        """Raises and warns as `uplift.build` does."""
        scene = Images(self.textures, self.encoding) if self.sparse else None
        return build(self.atlases or None, scene=scene, progress=progress, debug=debug, **self.options)


def read_plan(path: str | os.PathLike[str]) -> PlanFile:
    """Raises `PlanFileError` for no plan, and where a texture or an atlas is missing or has changed."""
    path = Path(path)
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
        if said["format"] != FORMAT:
            raise KeyError(said["format"])
        scene, options = said["scene"], dict(said["build"])
        options["lights"] = tuple(options["lights"])
        Options(**options).spectrum_model()
        textures, atlases = (
            {path.parent / str(each["path"]): str(each["digest"]) for each in scene[key]}
            for key in ("textures", "atlases")
        )
        sparse, encoding = said["cells"] == "sparse", str(scene["encoding"])
    except OSError as error:
        problem = f"cannot be read: {error.strerror or error}"
        raise PlanFileError(problem, path=path, hint="make it: uplift plan SCENE.toml") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, UpliftError) as error:
        raise PlanFileError("is no plan of this version", path=path, hint=AGAIN) from error
    for file, wanted in (textures | atlases).items():
        _check(path, file, wanted)
    return PlanFile(path, tuple(textures), tuple(atlases), encoding, sparse, options)


def _check(path: Path, file: Path, wanted: str) -> None:
    if not os.path.isfile(file):
        raise PlanFileError(f"there is no file {file}", path=path, hint=f"bring it back, or {AGAIN}")
    if file_digest(file) != wanted:
        raise PlanFileError(f"{file} has changed since the plan was measured", path=path, hint=AGAIN)
