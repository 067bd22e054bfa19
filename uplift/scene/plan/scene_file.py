"""SCENE.toml: the textures to render, the lights on them, and the tolerated colour error."""

import glob
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from uplift.colorimetry import Light, Sensor, observer
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, SCENE_LIGHTS
from uplift.common.arrays import StrPath
from uplift.common.errors import PlanFileError
from uplift.common.spec_file import InsidePath, SpecFile, SpecModel, problem, read_toml, resolves
from uplift.common.text import format_value
from uplift.io.texture.colours import check_encoding
from uplift.scene.plan.candidates import MINIMISE

MIN_TOLERANCE, MAX_TOLERANCE = 0.01, 100.0
"""ΔE00."""
MAX_PATH = 4096
"""Characters of a path. Matching longer patterns takes minutes."""


@dataclass(frozen=True)
class SceneFile:
    """Contents of a scene file. Paths are relative to the working directory, not to the file.

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
        One of `uplift.scene.plan.candidates.MINIMISE`.
    limits : mapping
        Largest cost by name: "memory" in bytes, "time" in operations, "samples".
    sparse : bool
        Whether the cube may have the cells of the textures alone.
    encoding : str
        Encoding of the textures: "auto", "linear" or "encoded".
    space, illuminant, observer : str
        RGB space of the textures.
    """

    path: Path
    textures: tuple[Path, ...]
    atlases: tuple[Path, ...] = ()
    lights: tuple[str, ...] = SCENE_LIGHTS
    tolerance: float = 1.0
    quantile: float = 0.975
    minimise: str = MINIMISE[0]
    limits: Mapping[str, float] = field(default_factory=dict)
    sparse: bool = True
    encoding: str = "auto"
    space: str = "sRGB"
    illuminant: str = DEFAULT_ILLUMINANT
    observer: str = observer.DEFAULT_OBSERVER

    def sensor(self) -> Sensor:
        """Look up the RGB space of the textures.

        Returns
        -------
        Sensor
            The space under its illuminant, for its observer.
        """
        return observer.sensor(self.space, self.illuminant, self.observer)

    def light_sources(self) -> tuple[Light, ...]:
        """Look up the lights.

        Returns
        -------
        tuple of Light
            One for each of `lights`.
        """
        return tuple(observer.light(name, self.observer) for name in self.lights)


def _check_path(name: str) -> str:
    if not name or len(name) > MAX_PATH or "\0" in name:
        text = f"must be a path of 1 to {MAX_PATH} characters without null bytes, got {format_value(name)}"
        raise problem(text, "name a file, or a pattern")
    return name


def _as_list(value: object) -> object:
    return [value] if isinstance(value, str) else value


def _canonical_light(name: str) -> str:
    return observer.light(name).name


Paths = Annotated[
    list[Annotated[InsidePath, AfterValidator(_check_path)]], BeforeValidator(_as_list), Field(min_length=1)
]
Lights = Annotated[
    list[Annotated[str, resolves(observer.light), AfterValidator(_canonical_light)]],
    BeforeValidator(_as_list),
    Field(min_length=1),
]
Limit = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Observer = Annotated[str, resolves(observer.matching_functions)]


class _SceneTable(SpecModel):
    """The keys of SCENE.toml."""

    textures: Paths
    atlases: Paths = Field(default_factory=list)
    lights: Lights = Field(default_factory=lambda: list(SceneFile.lights))
    tolerance: float = Field(SceneFile.tolerance, strict=True, ge=MIN_TOLERANCE, le=MAX_TOLERANCE, allow_inf_nan=False)
    quantile: float = Field(SceneFile.quantile, strict=True, ge=0.5, le=1, allow_inf_nan=False)
    minimise: Literal["balance", "memory", "time", "samples"] = "balance"
    limits: dict[Literal["memory", "time", "samples"], Limit] = Field(default_factory=dict)
    sparse: bool = SceneFile.sparse
    encoding: Annotated[str, resolves(check_encoding)] = SceneFile.encoding
    space: Annotated[str, resolves(observer.sensor)] = SceneFile.space
    illuminant: Annotated[str, resolves(observer.illuminant_spd)] = SceneFile.illuminant
    observer: Observer = SceneFile.observer


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
    table = file.validate(_SceneTable)
    values = {key: getattr(table, key) for key in table.model_fields_set}
    values |= {key: _expand(file, key, values[key]) for key in ("textures", "atlases") if key in values}
    values["lights"] = tuple(dict.fromkeys(table.lights))
    return SceneFile(file.path, **values)


def _expand(file: SpecFile, key: str, names: list[str]) -> tuple[Path, ...]:
    """Expand patterns in the folder of the scene file. Raises `PlanFileError` for names of no file."""
    folder, found = file.path.parent, []
    for number, name in enumerate(names):
        is_pattern = glob.has_magic(name) and not os.path.exists(folder / name)
        paths = [folder / each for each in sorted(glob.glob(name, root_dir=folder))] if is_pattern else [folder / name]
        if not paths or not all(map(os.path.isfile, paths)):
            text = f"no file named {format_value(name)}"
            hint = "paths start in the folder of the scene file"
            file.fail((key, number), text, code="file-not-found", hint=hint)
        found += paths
    return tuple(found)
