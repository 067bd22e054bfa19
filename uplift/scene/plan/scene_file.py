"""SCENE.toml: the textures to render, the lights on them, and the tolerated colour error."""

import glob
import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field

from uplift.colorimetry import Sensor, observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.common.arrays import StrPath
from uplift.common.errors import PlanFileError
from uplift.common.spec_file import SpecFile, check_inside, problem, read_toml, resolves
from uplift.common.text import format_value
from uplift.io.texture.colours import check_encoding
from uplift.scene.plan.candidates import CostName, Minimised

MIN_TOLERANCE, MAX_TOLERANCE = 0.01, 100.0
"""ΔE00."""
MAX_PATH = 4096
"""Characters of a path. Matching longer patterns takes minutes."""


def _check_path(name: Any) -> str:
    if not isinstance(name, str) or not 0 < len(name) <= MAX_PATH or "\0" in name:
        text = f"must be a path of 1 to {MAX_PATH} characters without null bytes, got {format_value(name)}"
        raise problem(text, "name a file, or a pattern")
    return check_inside(name)


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


def _light_names(names: tuple[str, ...]) -> tuple[str, ...]:
    """Each light once, as colour-science spells it."""
    return tuple(dict.fromkeys(observer.light(name).name for name in names))


Paths = Annotated[
    tuple[Annotated[Path, BeforeValidator(_check_path)], ...], BeforeValidator(_as_list), Field(min_length=1)
]
Lights = Annotated[
    tuple[Annotated[str, resolves(observer.light)], ...],
    BeforeValidator(_as_list),
    Field(min_length=1),
    AfterValidator(_light_names),
]
Observer = Annotated[str, resolves(observer.matching_functions)]


@dataclass(frozen=True)
class SceneFile:
    """Contents of a scene file, by its keys. Paths are relative to the working directory, not to the file.

    Parameters
    ----------
    path : Path
        The scene file.
    textures : tuple of Path
        Images whose colours are uplifted.
    atlases : tuple of Path
        Files of measured spectra that the textures are painted from.
    lights : tuple of str
        Illuminants of the scene.
    tolerance : float
        Tolerated ΔE00, in [0.01, 100].
    quantile : float
        Share of the textures' pixels and of the atlas's entries that must stay within the tolerance under every
        light, in [0.5, 1].
    minimise : str
        Cost that the choice minimises: "memory", "time", "samples", or "balance", the product of all three.
    limits : mapping
        Largest cost by name: "memory" in bytes, "time" in operations, "samples".
    sparse : bool
        Whether the cube may have the cells of the textures alone.
    encoding : str
        Encoding of the textures: "auto", "linear" or "encoded".
    space, illuminant, observer : str
        RGB space of the textures.
    """

    __pydantic_config__ = ConfigDict(extra="forbid")

    path: Annotated[Path, Field(strict=True)]
    textures: Paths
    atlases: Paths = ()
    lights: Lights = SCENE_LIGHTS
    tolerance: Annotated[float, Field(strict=True, ge=MIN_TOLERANCE, le=MAX_TOLERANCE, allow_inf_nan=False)] = 1.0
    quantile: Annotated[float, Field(strict=True, ge=0.5, le=1, allow_inf_nan=False)] = 0.975
    minimise: Minimised = "balance"
    limits: dict[CostName, Annotated[float, Field(gt=0, allow_inf_nan=False)]] = field(default_factory=dict)
    sparse: bool = True
    encoding: Annotated[str, resolves(check_encoding)] = "auto"
    space: Annotated[str, resolves(observer.sensor)] = "sRGB"
    illuminant: Annotated[str, resolves(observer.illuminant_spd)] = DEFAULT_ILLUMINANT
    observer: Observer = observer.DEFAULT_OBSERVER

    def sensor(self) -> Sensor:
        """Look up the RGB space of the textures.

        Returns
        -------
        Sensor
            The space under its illuminant, for its observer.
        """
        return observer.sensor(self.space, self.illuminant, self.observer)


def read_scene_file(path: StrPath) -> SceneFile:
    """Read a scene file.

    Parameters
    ----------
    path : path-like
        A TOML file. Its paths and patterns start in its own folder.

    Returns
    -------
    SceneFile
        Its contents. Patterns are expanded and every light is named once.

    Raises
    ------
    PlanFileError
        If the file cannot be read or a value does not fit, with the line and the key.
    """
    file = read_toml(path, PlanFileError)
    # No value of a TOML file is a path: the key is refused there.
    scene = replace(file, values={"path": file.path, **file.values}).validate(SceneFile)
    textures, atlases = _expand(file, "textures", scene.textures), _expand(file, "atlases", scene.atlases)
    return replace(scene, textures=textures, atlases=atlases)


def _expand(file: SpecFile, key: str, names: tuple[Path, ...]) -> tuple[Path, ...]:
    """Expand patterns in the folder of the scene file. Raises `PlanFileError` for names of no file."""
    folder, found = file.path.parent, list[Path]()
    for number, name in enumerate(map(str, names)):
        is_pattern = glob.has_magic(name) and not os.path.exists(folder / name)
        paths = sorted(glob.glob(name, root_dir=folder)) if is_pattern else [name]
        if not paths or not all(os.path.isfile(folder / each) for each in paths):
            text = f"no file named {format_value(name)}"
            hint = "paths start in the folder of the scene file"
            file.fail((key, number), text, code="file-not-found", hint=hint)
        found += (folder / each for each in paths)
    return tuple(found)
