"""Command lines that carry out a plan, and the options that select its candidates."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from uplift.common.arrays import Array
from uplift.io.texture import Spectrum
from uplift.pipeline.options import Options
from uplift.scene.plan.scene_file import SceneFile

if TYPE_CHECKING:
    from uplift.scene.plan.planning import Plan

SUFFIX = ".plan.json"
DEFAULTS = {field.name: field.default for field in fields(Options)}


def cube_args(options: Mapping[str, Any]) -> str:
    """Options of ``uplift build`` for fields of `Options` that have an option of their own name."""
    return " ".join(f"--{name} {value}" for name, value in options.items())


def wavelength_args(wavelengths: Array) -> str:
    """Option of ``uplift texture`` for wavelengths in nm."""
    return f"--wavelengths {','.join(f'{each:g}' for each in wavelengths)}"


def storage_args(form: str, depth: str) -> str:
    """Options of ``uplift texture`` for the contents of a pixel."""
    return f"--representation {form} --depth {depth}"


def compare_command(scene: SceneFile, limit: float) -> str:
    """``uplift compare`` for the lights and materials of a scene."""
    words = [*_repeat("--atlas", scene.atlases), *_repeat("--light", scene.lights)]
    return _join("uplift compare", [*words, "--tolerance", f"{limit:.3g}"])


def cube_name(plan_path: str | os.PathLike[str]) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


def build_command(path: Path) -> str:
    """``uplift build`` for the plan file at ``path``."""
    return _join("uplift build --plan", [path])


def expanded_command(plan: Plan, path: Path) -> str:
    """``uplift build`` with all options of the plan, which does not need the plan file."""
    scene, options = plan.scene, plan.options
    words = [*_repeat("--atlas", scene.atlases), "--dim", options["dim"], "--axis", options["axis"]]
    words += ["--coefficients", options["coefficients"], *_repeat("--light", options["lights"])]
    for name in ("space", "illuminant", "observer"):
        words += [] if options[name] == DEFAULTS[name] else [f"--{name}", options[name]]
    if plan.final_build.is_sparse:
        words += [*_repeat("--scene", scene.textures), *_encoding_args(scene)]
    return _join("uplift build", [*words, "-o", cube_name(path)])


def texture_command(plan: Plan, path: Path) -> str:
    """``uplift texture`` for all textures, as the plan stores them."""
    textures, storage = plan.scene.textures, plan.storage
    target = f"{textures[0].stem}-uplifted.exr" if len(textures) == 1 else "uplifted"
    words: list[object] = [*textures, "-o", target, "--cube", cube_name(path)]
    words += storage_args(storage.form, storage.depth).split()
    if storage.form == Spectrum.name:
        words += wavelength_args(plan.sampling.wavelengths).split()
    return _join("uplift texture", [*words, *_encoding_args(plan.scene)])


def _encoding_args(scene: SceneFile) -> list[str]:
    return [] if scene.encoding == SceneFile.encoding else ["--encoding", scene.encoding]


def _repeat(option: str, values: Iterable[object]) -> list[object]:
    """Words that give an option once for each value."""
    return [word for value in values for word in (option, value)]


def _join(command: str, words: Iterable[object]) -> str:
    """Command line of a command and its words, quoted for a shell."""
    return f"{command} {shlex.join(map(str, words))}"
