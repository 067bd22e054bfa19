"""Files of a plan: SCENE.toml, and the plan as `uplift build --plan` reads it. Both may
come from a stranger.
"""

import glob
import os
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BeforeValidator,
    Field,
    PlainValidator,
    ValidationInfo,
    model_validator,
)

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import (
    DEFAULT_ILLUMINANT,
    SCENE_LIGHTS,
    Illuminant,
)
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import StrPath
from uplift.common.errors import PlanFileError, unknown_name
from uplift.common.files import file_digest
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import format_value
from uplift.extras.emission.lamps import find_light, is_illuminant, lamp_file
from uplift.extras.files.spec import (
    SPEC,
    FolderPath,
    Number,
    SpecFolder,
    SpecModel,
    check_inside,
    looking_up,
    problem,
    read_spec,
    resolves,
    spec_folder,
)
from uplift.extras.images.reader import check_encoding
from uplift.extras.texture.scene_colours import Images
from uplift.lookup.cube import Cube
from uplift.pipeline.build import build
from uplift.pipeline.options import Options, recorded_options
from uplift.pipeline.stages import problem_of

FORMAT: Literal["uplift plan 1"] = "uplift plan 1"
HINT = "plan the scene again"
SUFFIX = ".plan.json"

CostName = Literal["memory", "time", "samples"]
Minimised = Literal["balance", CostName]
"""Cost that the choice minimises; the balance is the product of all three."""


def _listed(names: Any) -> Iterator[tuple[int, Any]]:
    """Number one name, or the names of a list that is not empty."""
    if not names or not isinstance(names, str | list):
        raise problem(f"must be a name or several, got {format_value(names)}")
    return enumerate([names] if isinstance(names, str) else names)


def _find_files(names: Any, info: ValidationInfo) -> tuple[Path, ...]:
    """Return the files of names and patterns in the folder of the scene file."""
    folder = spec_folder(info).path
    files = list[Path]()
    for number, name in _listed(names):
        path = folder / check_inside(name, number)
        is_pattern = glob.has_magic(name) and not os.path.exists(path)
        matches = sorted(glob.glob(name, root_dir=folder)) if is_pattern else [name]
        if not matches or not all(os.path.isfile(folder / match) for match in matches):
            text = f"no file named {format_value(name)}"
            hint = "paths start in the folder of this file"
            raise problem(text, hint, "file-not-found", at=(number,))
        files += (folder / match for match in matches)
    return tuple(files)


def _find_lights(names: Any, info: ValidationInfo) -> tuple[Illuminant, ...]:
    """Return each light once, with lamps read from the folder of the scene file."""
    folder = spec_folder(info)
    lights = list[Illuminant]()
    for number, name in _listed(names):
        text = str(folder.path / check_inside(name, number))
        file = lamp_file(text)
        with looking_up(number):
            if is_illuminant(name) or not os.path.lexists(file):
                lights.append(observer.light(name).name)
            else:
                folder.opened.append(Path(file))
                lights.append(find_light(text))
    with looking_up():
        observer.check_distinct(lights)
    return tuple(dict.fromkeys(lights))


def _refuse_key(value: Any) -> Any:
    raise problem("unknown key", "leave it out")


Files = Annotated[tuple[Path, ...], PlainValidator(_find_files)]
ObserverName = Annotated[str, resolves(observer.matching_functions)]


@dataclass(frozen=True)
class SceneFile:
    """Contents of a scene file, by its keys. Paths are relative to the working
    directory, not to the file.

    Parameters
    ----------
    path : Path
        The scene file.
    textures : tuple of Path
        Images whose colours are uplifted.
    atlases : tuple of Path
        Files of measured spectra that the textures are painted from.
    lights : tuple of str or Lamp
        Illuminants of the scene.
    tolerance : float
        Tolerated ΔE00, in [0.01, 100].
    quantile : float
        Share of the textures' pixels and of the atlas's entries that must stay within
        the tolerance under every light, in [0.5, 1].
    minimise : str
        Cost that the choice minimises: "memory", "time", "samples", or "balance", the
        product of all three.
    limits : mapping
        Largest cost by name: "memory" in bytes, "time" in operations, "samples".
    sparse : bool
        Whether the cube may have the cells of the textures alone.
    encoding : str
        Encoding of the textures: "auto", "linear" or "encoded".
    space, illuminant, observer : str
        RGB space of the textures.
    lamp_files : tuple of Path
        Files of those of the lights that are lamps.
    """

    __pydantic_config__ = SPEC

    path: Annotated[Path, Field(strict=True)]
    textures: Files
    atlases: Files = ()
    lights: Annotated[tuple[Illuminant, ...], PlainValidator(_find_lights)] = (
        SCENE_LIGHTS
    )
    tolerance: Annotated[Number, Field(ge=0.01, le=100)] = 1.0
    quantile: Annotated[Number, Field(ge=0.5, le=1)] = 0.975
    minimise: Minimised = "balance"
    limits: dict[CostName, Annotated[Number, Field(gt=0)]] = field(default_factory=dict)
    sparse: bool = True
    encoding: Annotated[str, resolves(check_encoding)] = "auto"
    space: Annotated[str, resolves(observer.sensor)] = "sRGB"
    illuminant: Annotated[str, resolves(observer.illuminant_spd)] = DEFAULT_ILLUMINANT
    observer: ObserverName = observer.DEFAULT_OBSERVER
    lamp_files: Annotated[tuple[Path, ...], BeforeValidator(_refuse_key)] = ()

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
        If the file cannot be read or a value does not fit; the error names the key.
    """
    folder = SpecFolder(Path(path).parent)
    given = {"path": Path(path)}  # a path of a TOML file is text, which is refused
    scene = read_spec(path, SceneFile, PlanFileError, given=given, folder=folder)
    return replace(scene, lamp_files=tuple(folder.opened))


def cube_name(plan_path: StrPath) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    stem = name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem
    return f"{stem}.uplift"


class _Source(SpecModel):
    """A texture or an atlas that has not changed since the plan was made."""

    path: FolderPath
    digest: str

    @model_validator(mode="after")
    def _check(self) -> Self:
        name = format_value(self.path.name)
        if not os.path.isfile(self.path):
            text, code = f"no file named {name}", "file-not-found"
        elif file_digest(self.path) != self.digest:
            text, code = f"{name} has changed since the plan was made", "source-changed"
        else:
            return self
        raise problem(text, HINT, code, at=("path",))


class _Scene(SpecModel, extra="ignore"):
    encoding: Annotated[str, resolves(check_encoding)]
    textures: Annotated[list[_Source], Field(min_length=1)]
    atlases: list[_Source]


def _build_options(values: Any) -> dict[str, Any]:
    """Return options that a build accepts, and for which it opens no file, as for a
    camera.
    """
    if values is None:
        hint = "render as its key 'rendering' describes"
        raise problem("the plan needs no cube", hint)
    if not isinstance(values, dict):
        raise problem(f"must be a table, got {format_value(values)}")
    known = [field.name for field in fields(Options)]
    with looking_up():
        for name in values:
            if name not in known:
                raise unknown_name(name, known, "option")
        recorded = recorded_options(values)
        options = Options(**recorded)
        observer.matching_functions(str(options.observer))
        problem_of(options)
    return recorded


class PlanFile(SpecModel, extra="ignore"):
    """What a build needs of a plan: its unchanged sources, the ``options`` of the
    build, and whether it has all ``cells``.
    """

    format: Literal["uplift plan 1"]
    scene: _Scene
    options: Annotated[
        dict[str, Any], PlainValidator(_build_options), Field(alias="build")
    ]
    cells: Literal["sparse", "whole"]

    @property
    def images(self) -> Images:
        """Textures of the scene."""
        paths = tuple(source.path for source in self.scene.textures)
        return Images(paths, self.scene.encoding)

    @property
    def atlases(self) -> tuple[Path, ...]:
        """Atlases of the scene."""
        return tuple(source.path for source in self.scene.atlases)

    def build(
        self, *, debug: bool = False, progress: ProgressCallback = ignore_progress
    ) -> Cube:
        """Build the planned cube, with the warnings and errors of `uplift.build`."""
        scene = self.images if self.cells == "sparse" else None
        return build(
            self.atlases or None,
            scene=scene,
            progress=progress,
            **self.options | {"debug": debug},
        )


def read_plan(path: StrPath) -> PlanFile:
    """Read a plan. Raises `PlanFileError`, also if a texture or an atlas is missing,
    has changed, or lies elsewhere.
    """
    return read_spec(path, PlanFile, PlanFileError, kind="JSON", hint=HINT)
