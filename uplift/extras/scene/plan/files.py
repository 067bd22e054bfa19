"""Files of a plan: SCENE.toml, and the plan as `uplift build --plan` reads it. Both may
come from a stranger.
"""

import glob
import os
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import (
    DEFAULT_ILLUMINANT,
    SCENE_LIGHTS,
    Illuminant,
    Lamp,
)
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import StrPath
from uplift.common.errors import (
    OptionError,
    PlanFileError,
    UnknownNameError,
    UpliftError,
    unknown_name,
)
from uplift.common.files import file_digest
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import format_value
from uplift.extras.emission.lamps import find_light, is_illuminant, lamp_file
from uplift.extras.files.spec import (
    SpecFile,
    SpecModel,
    check_inside,
    problem,
    read_json,
    read_toml,
    resolves,
)
from uplift.extras.texture.colours import check_encoding
from uplift.extras.texture.scene_colours import Images
from uplift.lookup.cube import Cube
from uplift.pipeline.build import build
from uplift.pipeline.options import Options, recorded_options
from uplift.pipeline.stages import problem_of

FORMAT: Literal["uplift plan 1"] = "uplift plan 1"
HINT = "plan the scene again"
MAX_FILES = 10_000
SUFFIX = ".plan.json"
MAX_PATH = 4096
"""Characters of a path. Matching longer patterns takes minutes."""

CostName = Literal["memory", "time", "samples"]
Minimised = Literal["balance", CostName]
"""Cost that the choice minimises; the balance is the product of all three."""


def _check_path(name: Any) -> str:
    if not isinstance(name, str) or not 0 < len(name) <= MAX_PATH or "\0" in name:
        text = (
            f"must be a path of 1 to {MAX_PATH} characters without null bytes, got "
            f"{format_value(name)}"
        )
        raise problem(text, "name a file, or a pattern")
    return check_inside(name)


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


def _check_light(name: Any) -> str:
    """Check the name of an illuminant, or else that of a file in the folder of the
    scene file.
    """
    if not isinstance(name, str):
        raise problem(f"must be text, got {format_value(name)}")
    try:
        return observer.light(name).name
    except UnknownNameError as error:
        if not os.path.splitext(name)[1]:
            raise problem(error.problem, error.hint, error.code) from error
    except UpliftError as error:
        raise problem(error.problem, error.hint, error.code) from error
    return _check_path(name)


def _refuse_key(value: Any) -> Any:
    raise problem("unknown key", "leave it out")


Paths = Annotated[
    tuple[Annotated[Path, BeforeValidator(_check_path)], ...],
    BeforeValidator(_as_list),
    Field(min_length=1),
]
Lights = Annotated[
    tuple[Annotated[Any, BeforeValidator(_check_light)], ...], BeforeValidator(_as_list)
]
Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Observer = Annotated[str, resolves(observer.matching_functions)]


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

    __pydantic_config__ = ConfigDict(extra="forbid")

    path: Annotated[Path, Field(strict=True)]
    textures: Paths
    atlases: Paths = ()
    lights: Annotated[Lights, Field(min_length=1)] = SCENE_LIGHTS
    tolerance: Annotated[Finite, Field(ge=0.01, le=100)] = 1.0
    quantile: Annotated[Finite, Field(ge=0.5, le=1)] = 0.975
    minimise: Minimised = "balance"
    limits: dict[CostName, Annotated[float, Field(gt=0, allow_inf_nan=False)]] = field(
        default_factory=dict
    )
    sparse: bool = True
    encoding: Annotated[str, resolves(check_encoding)] = "auto"
    space: Annotated[str, resolves(observer.sensor)] = "sRGB"
    illuminant: Annotated[str, resolves(observer.illuminant_spd)] = DEFAULT_ILLUMINANT
    observer: Observer = observer.DEFAULT_OBSERVER
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
    file = read_toml(path, PlanFileError)
    # No value of a TOML file is a path: the key is refused there.
    scene = replace(file, values={"path": file.path, **file.values}).validate(SceneFile)
    textures = _expand(file, "textures", scene.textures)
    atlases = _expand(file, "atlases", scene.atlases)
    lights, lamp_files = _read_lights(file, scene.lights)
    return replace(
        scene, textures=textures, atlases=atlases, lights=lights, lamp_files=lamp_files
    )


def _read_lights(
    file: SpecFile, names: tuple[str, ...]
) -> tuple[tuple[Illuminant, ...], tuple[Path, ...]]:
    """Return each light once, with lamps read from the folder of the scene file, and
    the files of the lamps.
    """
    lights = list[Illuminant]()
    files = list[Path]()
    for number, name in enumerate(dict.fromkeys(names)):
        try:
            in_folder = str(file.path.parent / name)
            lights.append(name if is_illuminant(name) else find_light(in_folder))
        except UnknownNameError as error:
            file.fail(
                ("lights", number),
                f"unknown illuminant {format_value(name)}",
                code=error.code,
                hint=error.hint,
            )
        except UpliftError as error:
            file.fail(("lights", number), str(error), code=error.code)
        if isinstance(lights[-1], Lamp):
            files.append(Path(lamp_file(in_folder)))
    try:
        observer.check_distinct(lights)
    except OptionError as error:
        file.fail(("lights",), error.problem, code=error.code, hint=error.hint)
    return tuple(dict.fromkeys(lights)), tuple(files)


def _expand(file: SpecFile, key: str, names: tuple[Path, ...]) -> tuple[Path, ...]:
    """Expand patterns in the folder of the scene file. Raises `PlanFileError` for names
    of no file.
    """
    folder = file.path.parent
    expanded = list[Path]()
    for number, name in enumerate(map(str, names)):
        is_pattern = glob.has_magic(name) and not os.path.exists(folder / name)
        paths = sorted(glob.glob(name, root_dir=folder)) if is_pattern else [name]
        if not paths or not all(os.path.isfile(folder / path) for path in paths):
            file.fail(
                (key, number),
                f"no file named {format_value(name)}",
                code="file-not-found",
                hint="paths start in the folder of this file",
            )
        expanded += (folder / path for path in paths)
    return tuple(expanded)


def cube_name(plan_path: StrPath) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    stem = name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem
    return f"{stem}.uplift"


@dataclass(frozen=True)
class PlanFile:
    """What a build needs of a plan: its unchanged sources, the ``options`` of the
    build, and whether it is sparse.
    """

    images: Images
    atlases: tuple[Path, ...]
    sparse: bool
    options: dict[str, Any]

    def build(
        self, *, debug: bool = False, progress: ProgressCallback = ignore_progress
    ) -> Cube:
        """Build the planned cube, with the warnings and errors of `uplift.build`."""
        scene = self.images if self.sparse else None
        return build(
            self.atlases or None,
            scene=scene,
            progress=progress,
            **self.options | {"debug": debug},
        )


class _Source(SpecModel):
    """A texture or an atlas with its SHA-256."""

    path: Annotated[str, BeforeValidator(_check_path)]
    digest: str


class _Scene(SpecModel, extra="ignore"):
    encoding: Annotated[str, resolves(check_encoding)]
    textures: Annotated[list[_Source], Field(min_length=1, max_length=MAX_FILES)]
    atlases: Annotated[list[_Source], Field(max_length=MAX_FILES)]


def _check_options(values: dict[str, Any]) -> None:
    """Raise `UpliftError` unless a build accepts the options and opens no file for
    them, as for a camera.
    """
    known = [field.name for field in fields(Options)]
    for name in values:
        if name not in known:
            raise unknown_name(name, known, "option")
    options = Options(**recorded_options(values))
    observer.matching_functions(str(options.observer))
    problem_of(options)


class _PlanTable(SpecModel, extra="ignore"):
    """The keys of a plan file that a build needs."""

    format: Literal["uplift plan 1"]
    scene: _Scene
    build: Annotated[dict[str, Any], resolves(_check_options)] | None
    cells: Literal["sparse", "whole"]


def read_plan(path: StrPath) -> PlanFile:
    """Read a plan. Raises `PlanFileError`, also if a texture or an atlas is missing,
    has changed, or lies elsewhere.
    """
    file = read_json(path, PlanFileError)
    table = file.validate(_PlanTable, hint=HINT)
    if table.build is None:
        file.fail(
            ("build",),
            "the plan needs no cube",
            hint="render as its key 'rendering' describes",
        )
    textures, atlases = (
        _check_sources(file, key, getattr(table.scene, key))
        for key in ("textures", "atlases")
    )
    images = Images(textures, table.scene.encoding)
    return PlanFile(
        images, atlases, table.cells == "sparse", recorded_options(table.build)
    )


def _check_sources(
    file: SpecFile, key: str, sources: list[_Source]
) -> tuple[Path, ...]:
    paths = [file.path.parent / source.path for source in sources]
    for number, (source, path) in enumerate(zip(sources, paths, strict=True)):
        keys = "scene", key, number, "path"
        if not os.path.isfile(path):
            file.fail(
                keys,
                f"no file named {format_value(source.path)}",
                code="file-not-found",
                hint=f"restore it, or {HINT}",
            )
        if file_digest(path) != source.digest:
            text = f"{format_value(source.path)} has changed since the plan was made"
            file.fail(keys, text, code="source-changed", hint=HINT)
    return tuple(paths)
