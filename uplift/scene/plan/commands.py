"""What to type: a plan as command lines."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path

from uplift.io.texture import Spectrum
from uplift.pipeline.options import Options
from uplift.scene.plan.planning import Plan
from uplift.scene.plan.wavelengths import format_wavelengths

SUFFIX = ".plan.json"
DEFAULTS = {field.name: field.default for field in fields(Options)}


def cube_name(plan_path: str | os.PathLike[str]) -> str:
    """kitchen.plan.json → kitchen.uplift."""
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


def build_command(path: Path) -> str:
    """Of the plan at ``path``."""
    return _line("uplift build --plan", [path])


def expanded_command(plan: Plan, path: Path) -> str:
    """The same build without the plan's file."""
    scene, options = plan.scene, plan.options
    words = [word for atlas in scene.atlases for word in ("--atlas", atlas)]
    words += ["--dim", options["dim"], "--axis", options["axis"], "--moments", options["coefficients"] - 1]
    words += [word for light in options["lights"] for word in ("--light", light)]
    for name in ("space", "illuminant", "observer"):
        words += [] if options[name] == DEFAULTS[name] else [f"--{name}", options[name]]
    if plan.final_build.is_sparse:
        words += [word for texture in scene.textures for word in ("--scene", texture)]
        words += _encoding(plan)
    return _line("uplift build", [*words, "-o", cube_name(path)])


def texture_command(plan: Plan, path: Path) -> str:
    """All textures uplifted as the plan stores them."""
    textures, held = plan.scene.textures, plan.storage
    target = f"{textures[0].stem}-uplifted.exr" if len(textures) == 1 else "uplifted"
    words = [*textures, target, "--cube", cube_name(path), "--store", held.form, "--depth", held.depth]
    if held.form == Spectrum.name:
        words += ["--wavelengths", format_wavelengths(plan.sampling)]
    return _line("uplift texture", [*words, *_encoding(plan)])


def _encoding(plan: Plan) -> list[str]:
    return [] if plan.scene.encoding == "auto" else ["--encoding", plan.scene.encoding]


def _line(command: str, words: Iterable[object]) -> str:
    return f"{command} {shlex.join(map(str, words))}"
