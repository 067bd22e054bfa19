"""Command lines that carry out a plan."""

from __future__ import annotations

import os
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

from uplift.io.texture import Spectrum
from uplift.pipeline.options import Options
from uplift.scene.plan.arguments import join_words, repeat_option, storage_args, wavelength_args
from uplift.scene.plan.scene_file import SceneFile

if TYPE_CHECKING:
    from uplift.scene.plan.planning import Plan

SUFFIX = ".plan.json"
DEFAULTS = {field.name: field.default for field in fields(Options)}


def cube_name(plan_path: str | os.PathLike[str]) -> str:
    """File name of the cube of a plan.

    >>> cube_name("plans/kitchen.plan.json")
    'kitchen.uplift'
    """
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


def build_command(path: Path) -> str:
    """``uplift build`` for the plan file at ``path``."""
    return join_words("uplift build --plan", [path])


def expanded_command(plan: Plan, path: Path) -> str:
    """``uplift build`` with all options of the plan, which does not need the plan file."""
    scene, options = plan.scene, plan.options
    words = [*repeat_option("--atlas", scene.atlases), "--dim", options["dim"], "--axis", options["axis"]]
    words += ["--coefficients", options["coefficients"], *repeat_option("--light", options["lights"])]
    for name in ("space", "illuminant", "observer"):
        words += [] if options[name] == DEFAULTS[name] else [f"--{name}", options[name]]
    if plan.final_build.is_sparse:
        words += [*repeat_option("--scene", scene.textures), *_encoding_args(scene)]
    return join_words("uplift build", [*words, "-o", cube_name(path)])


def texture_command(plan: Plan, path: Path) -> str:
    """``uplift texture`` for all textures, as the plan stores them."""
    textures, storage = plan.scene.textures, plan.storage
    target = f"{textures[0].stem}-uplifted.exr" if len(textures) == 1 else "uplifted"
    words = [*textures, "-o", target, "--cube", cube_name(path), *storage_args(storage.form, storage.depth).split()]
    if storage.form == Spectrum.name:
        words += wavelength_args(plan.sampling.wavelengths).split()
    return join_words("uplift texture", [*words, *_encoding_args(plan.scene)])


def _encoding_args(scene: SceneFile) -> list[str]:
    return [] if scene.encoding == SceneFile.encoding else ["--encoding", scene.encoding]
