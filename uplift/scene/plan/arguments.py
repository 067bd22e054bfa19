"""Options of the command line that select the candidates of a plan."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from typing import Any

from uplift.common.arrays import Array
from uplift.scene.plan.scene_file import SceneFile


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
    words = [*repeat_option("--atlas", scene.atlases), *repeat_option("--light", scene.lights)]
    return join_words("uplift compare", [*words, "--tolerance", f"{limit:.3g}"])


def repeat_option(option: str, values: Iterable[object]) -> list[object]:
    """Words that give an option once for each value."""
    return [word for value in values for word in (option, value)]


def join_words(command: str, words: Iterable[object]) -> str:
    """Command line of a command and its words, quoted for a shell."""
    return f"{command} {shlex.join(map(str, words))}"
