"""Plan files as ``uplift build --plan`` reads them. They may come from a stranger."""

import os
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from uplift.colorimetry.observer import matching_functions
from uplift.common.arrays import StrPath
from uplift.common.errors import PlanFileError, unknown_name
from uplift.common.files import file_digest
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.spec_file import InsidePath, SpecFile, SpecModel, read_json, resolves
from uplift.common.text import format_value
from uplift.io.scene_colours import Images
from uplift.io.texture.colours import check_encoding
from uplift.lookup import Cube
from uplift.pipeline.build import build, problem_of
from uplift.pipeline.options import Options, recorded_options

FORMAT: Literal["uplift plan 1"] = "uplift plan 1"
HINT = "plan the scene again"
MAX_FILES = 10_000
SUFFIX = ".plan.json"


def cube_name(plan_path: StrPath) -> str:
    """File name of the cube of a plan: that of the plan with the suffix ``.uplift``."""
    name = Path(plan_path).name
    return f"{name.removesuffix(SUFFIX) if name.endswith(SUFFIX) else Path(name).stem}.uplift"


@dataclass(frozen=True)
class PlanFile:
    """What a build needs of a plan: its unchanged sources, the ``options`` of the build, and whether it is sparse."""

    images: Images
    atlases: tuple[Path, ...]
    sparse: bool
    options: dict[str, Any]

    def build(self, *, debug: bool = False, progress: ProgressCallback = ignore_progress) -> Cube:
        """Build the planned cube, with the warnings and errors of `uplift.build`."""
        scene = self.images if self.sparse else None
        return build(self.atlases or None, scene=scene, progress=progress, **self.options | {"debug": debug})


class _Source(SpecModel):
    """A texture or an atlas with its SHA-256."""

    path: InsidePath
    digest: str


class _Scene(SpecModel, extra="ignore"):
    """Source files of a plan."""

    encoding: Annotated[str, resolves(check_encoding)]
    textures: Annotated[list[_Source], Field(min_length=1, max_length=MAX_FILES)]
    atlases: Annotated[list[_Source], Field(max_length=MAX_FILES)]


def _check_options(values: dict[str, Any]) -> None:
    """Raise `UpliftError` unless a build accepts the options and opens no file for them, as for a camera."""
    known = [field.name for field in fields(Options)]
    for name in values:
        if name not in known:
            raise unknown_name(name, known, "option")
    options = Options(**recorded_options(values))
    matching_functions(options.observer)
    problem_of(options, options.observer, options.solver)


class _PlanTable(SpecModel, extra="ignore"):
    """The keys of a plan file that a build needs."""

    format: Literal["uplift plan 1"]
    scene: _Scene
    build: Annotated[dict[str, Any], resolves(_check_options)] | None
    cells: Literal["sparse", "whole"]


def read_plan(path: StrPath) -> PlanFile:
    """Read a plan file.

    Raises `PlanFileError` if it is not a valid plan, or a texture or an atlas is missing, has changed, or lies outside
    the folder of the file.
    """
    file = read_json(path, PlanFileError)
    table = file.validate(_PlanTable, hint=HINT)
    if table.build is None:
        file.fail(("build",), "the plan needs no cube", hint="render as its key 'rendering' describes")
    textures, atlases = (_check_sources(file, key, getattr(table.scene, key)) for key in ("textures", "atlases"))
    images = Images(textures, table.scene.encoding)
    return PlanFile(images, atlases, table.cells == "sparse", recorded_options(table.build))


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
