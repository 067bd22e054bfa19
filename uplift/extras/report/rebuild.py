"""Repeat a build from the options and atlas files that a cube recorded."""

import os
import warnings
from collections.abc import Callable, Sequence, Set
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from uplift.atlas.atlas import Atlas, merge
from uplift.atlas.document import read_document
from uplift.atlas.sources import read_atlas, shipped_atlases
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.observer import is_camera_file
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Mask, StrPath
from uplift.common.errors import (
    CubeFileError,
    LookError,
    OptionError,
    UnknownNameError,
    UpliftWarning,
    warn,
)
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.common.version import is_older, version
from uplift.cube.data import CubeData
from uplift.extras.looks.targets import recorded_looks
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lookup.cube import Cube
from uplift.pipeline.build import build
from uplift.pipeline.options import CUSTOM, Options, recorded_options

REBUILD = "build the cube again"
"""Hint for cubes whose build cannot be repeated."""
SEARCH = "pass the folder that contains it, or build the cube again"
"""Hint for atlases that are missing or have changed."""


@dataclass(frozen=True, eq=False)
class StoredScene:
    """The scene of a cube that was built for images: its present nodes replace the
    images.
    """

    data: CubeData

    def required_points(
        self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback
    ) -> Mask:
        """Return the nodes that are present in the cube; see `SceneLike`."""
        if self.data.lattice.dim != boxes.lattice.dim:
            raise OptionError(
                f"a stored scene of dim {self.data.lattice.dim} needs it, got "
                f"{boxes.lattice.dim}"
            )
        return self.data.points.present

    def describe(self) -> list[dict[str, Any]]:
        """Return the sources that the cube recorded; see `SceneLike`."""
        return list(self.data.provenance["scene"])


def rebuild(
    stored: Cube,
    path: StrPath,
    folders: Sequence[StrPath] = (),
    *,
    progress: ProgressCallback = ignore_progress,
) -> Cube:
    """Build a cube, read from ``path``, again. Warnings of the first build are not
    repeated.

    Atlas files are searched as by `recorded_atlas`. A file that has changed is used,
    with the `UpliftWarning` ``atlas-changed``. A cube of an earlier version of uplift
    gives the `UpliftWarning` ``older-version``. Raises `CubeFileError` if the cube does
    not record its options, was filled from another cube, or an atlas file is missing.
    """
    options = _read_options(stored.data, path)
    if "filled" in stored.data.provenance:
        raise CubeFileError(
            "was filled from another cube and cannot be rebuilt",
            path=path,
            hint="rebuild the cube that was filled",
        )
    writer = stored.data.provenance.get("uplift", "")
    if is_older(writer, version()):
        problem = (
            f"was written by version {writer} of uplift, older than this one, "
            f"{version()}"
        )
        warn(UpliftWarning(problem, code="older-version", path=path))
    atlases = _find_all(stored.data, path, "atlases", folders, warn)
    library = tuple(_find_all(stored.data, path, "libraries", folders, warn))
    atlas = _read(stored.data, atlases)
    scene = StoredScene(stored.data) if "scene" in stored.data.provenance else None
    given = asdict(options) | {"lights": options.lights}
    sensor = stored.data.sensor
    if sensor.sensitivities is not None:
        given["observer"] = Camera(
            sensor.space, sensor.wavelengths, sensor.sensitivities
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        try:
            looks = recorded_looks(stored.data.provenance)
            return build(
                atlas,
                library=library,
                looks=looks,
                scene=scene,
                progress=progress,
                **given,
            )
        except (LookError, OptionError, UnknownNameError) as error:
            if error.code == "out-of-memory":
                raise
            raise _unknown_options(error, path) from error


def recorded_atlas(
    data: CubeData, path: StrPath, folders: Sequence[StrPath] = ()
) -> Atlas | None:
    """Read the atlas that a cube, read from ``path``, was built from; None for a cube
    without one. Warnings of the build are not repeated.

    The first file of the recorded name decides, in ``folders``, in the folder of the
    cube, and in folders ``atlases`` in these. Where there is none, a shipped atlas of
    the recorded content counts, with the `UpliftWarning` ``shipped-atlas`` if it has
    another name. A recorded name never opens a file elsewhere. Raises `CubeFileError`
    if the cube does not record its atlas, or a file is missing or has changed.
    """

    def handle(warning: UpliftWarning) -> None:
        if warning.code == "atlas-changed":
            raise CubeFileError(
                warning.problem, code="atlas-changed", path=path, hint=SEARCH
            )
        warn(warning)

    return _read(data, _find_all(data, path, "atlases", folders, handle))


def _read(data: CubeData, files: Sequence[Path]) -> Atlas | None:
    """Read the recorded atlas from its files."""
    atlases = list[Atlas]()
    for file, source in zip(files, data.provenance["atlases"], strict=True):
        options = {key: source[key] for key in ("measured", "missing") if key in source}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UpliftWarning)
            atlases.append(read_atlas(file, **options))
    return merge(atlases) if atlases else None


Handler = Callable[[UpliftWarning], None]
"""What is done about a file that has another content, or a shipped atlas of another
name.
"""


def _find_all(
    data: CubeData, path: StrPath, kind: str, folders: Sequence[StrPath], warn: Handler
) -> list[Path]:
    """Find the recorded files of a kind. Only a plain name is searched in folders, no
    path on any system.
    """
    if kind == "atlases" and kind not in data.provenance:
        raise _missing_provenance(path)
    searched = list[Path]()
    for root in (*map(Path, folders), Path(path).resolve().parent):
        searched += [root, root / "atlases"]
    sources = data.provenance.get(kind, ())
    # Files of one name in two folders may both be recorded.
    digests = {source["digest"] for source in sources}
    files = []
    for source in sources:
        name = source["name"]
        digest = source["digest"]
        named = list[Path]()
        if not set(name) & set("/\\:"):
            named = [folder / name for folder in searched]
        file = _first_of_name(path, named, digest, digests - {digest}, warn)
        file = file or _shipped(path, name, digest, warn)
        if file is None:
            raise CubeFileError(
                f"its atlas '{name}' was not found",
                code="atlas-not-found",
                path=path,
                hint=SEARCH,
            )
        files.append(file)
    return files


def _first_of_name(
    path: StrPath, named: Sequence[Path], digest: str, others: Set[str], warn: Handler
) -> Path | None:
    """Return the first file whose content is not one of the ``others``."""
    for file in filter(os.path.isfile, named):
        content = read_document(file).digest
        if content not in others:
            if content != digest:
                problem = f"its atlas '{file.name}' has changed ({file})"
                warn(UpliftWarning(problem, code="atlas-changed", path=path))
            return file
    return None


def _shipped(path: StrPath, name: str, digest: str, warn: Handler) -> Path | None:
    """Return the shipped atlas of a content."""
    atlas = next((atlas for atlas in shipped_atlases() if atlas.digest == digest), None)
    if atlas is None:
        return None
    if atlas.path.name != name:
        problem = (
            f"its atlas '{name}' was not found; the shipped atlas '{atlas.name}' has "
            "its content"
        )
        warn(UpliftWarning(problem, code="shipped-atlas", path=path))
    return atlas.path


def _read_options(data: CubeData, path: StrPath) -> Options:
    if not data.provenance.get("options"):
        raise _missing_provenance(path)
    try:
        options = Options(**recorded_options(data.provenance["options"]))
        if is_camera_file(str(options.observer)) and data.sensor.sensitivities is None:
            raise OptionError("the file of a camera without its sensitivities")
    except (TypeError, OptionError, UnknownNameError) as error:
        raise _unknown_options(error, path) from error
    if options.solver == CUSTOM:
        raise CubeFileError(
            "was built with a solver that was given as an object, which a cube "
            "cannot record",
            path=path,
            hint="build it again with that solver, or with a named one",
        )
    if options.dim != data.lattice.dim:
        raise CubeFileError(
            f"records dim {options.dim}, but has "
            f"{pluralise(data.lattice.dim, 'node')} along each axis",
            path=path,
            hint=REBUILD,
        )
    return options


def _missing_provenance(path: StrPath) -> CubeFileError:
    return CubeFileError("does not record how it was built", path=path, hint=REBUILD)


def _unknown_options(error: Exception, path: StrPath) -> CubeFileError:
    return CubeFileError(
        f"records options that this version does not have ({error})",
        path=path,
        hint=REBUILD,
    )
