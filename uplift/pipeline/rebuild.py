"""Repeat a build from the options and atlas files that a cube recorded."""

import os
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from uplift.atlas import Atlas, merge, read_atlas, shipped_atlases
from uplift.atlas.document import read_document
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.observer import is_camera_file
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Mask, StrPath
from uplift.common.errors import CubeFileError, LookError, OptionError, UnknownNameError, UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.cube import CubeData
from uplift.lattice import EntryBoxes
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.pipeline.looks import recorded_looks
from uplift.pipeline.options import CUSTOM, Options, recorded_options

REBUILD = "build the cube again"
"""Hint for cubes whose build cannot be repeated."""


@dataclass(frozen=True, eq=False)
class StoredScene:
    """The scene of a cube that was built for images: its present nodes replace the images."""

    data: CubeData

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Return the nodes that are present in the cube; see `SceneLike`."""
        if self.data.lattice.dim != boxes.lattice.dim:
            raise OptionError(f"a stored scene of dim {self.data.lattice.dim} needs it, got {boxes.lattice.dim}")
        return self.data.points.present

    def describe(self) -> list[dict[str, Any]]:
        """Return the sources that the cube recorded; see `SceneLike`."""
        return list(self.data.provenance["scene"])


def rebuild(
    stored: Cube, path: StrPath, folders: Sequence[StrPath] = (), *, progress: ProgressCallback = ignore_progress
) -> Cube:
    """Build a cube, read from ``path``, again. Warnings of the first build are not repeated.

    Atlas files are searched as by `recorded_atlas`. A file that has changed is used, with the `UpliftWarning`
    ``atlas-changed``. Raises `CubeFileError` if the cube does not record its options, was filled from another cube, or
    an atlas file is missing.
    """
    options = _read_options(stored.data, path)
    if "filled" in stored.data.provenance:
        raise CubeFileError(
            "was filled from another cube and cannot be rebuilt", path=path, hint="rebuild the cube that was filled"
        )
    atlases, libraries = (_find_all(stored.data, path, kind, folders) for kind in ("atlases", "libraries"))
    for error in filter(None, (*atlases.values(), *libraries.values())):
        warnings.warn(UpliftWarning(error.problem, code=error.code, path=path), stacklevel=2)
    atlas, library = _read(stored.data, atlases), tuple(libraries)
    scene = StoredScene(stored.data) if "scene" in stored.data.provenance else None
    given = asdict(options)
    sensor = stored.data.sensor
    if sensor.sensitivities is not None:
        given["observer"] = Camera(sensor.space, sensor.wavelengths, sensor.sensitivities)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        try:
            looks = recorded_looks(stored.data.provenance)
            return build(atlas, library=library, looks=looks, scene=scene, progress=progress, **given)
        except (LookError, OptionError, UnknownNameError) as error:
            if error.code == "out-of-memory":
                raise
            raise _unknown_options(error, path) from error


def recorded_atlas(data: CubeData, path: StrPath, folders: Sequence[StrPath] = ()) -> Atlas | None:
    """Read the atlas that a cube, read from ``path``, was built from; None for a cube without one.

    The files are searched by name and digest in ``folders``, in the folder of the cube, and in folders ``atlases`` in
    these, and by digest among the shipped atlases. A recorded name never opens a file elsewhere. Warnings are not
    repeated. Raises `CubeFileError` if the cube does not record its atlas, or a file is missing or has changed.
    """
    files = _find_all(data, path, "atlases", folders)
    for error in filter(None, files.values()):
        raise error
    return _read(data, files)


def _read(data: CubeData, files: Iterable[Path]) -> Atlas | None:
    """Read the recorded atlas from its files."""
    scales = [source.get("measured", "auto") for source in data.provenance["atlases"]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        atlases = [read_atlas(file, measured=scale) for file, scale in zip(files, scales, strict=True)]
    return merge(atlases) if atlases else None


def _find_all(data: CubeData, path: StrPath, kind: str, folders: Sequence[StrPath]) -> dict[Path, CubeFileError | None]:
    """Find the recorded files of a kind, each with an error if it has changed."""
    if kind == "atlases" and kind not in data.provenance:
        raise _missing_provenance(path)
    roots = [*map(Path, folders), Path(path).resolve().parent]
    searched = [folder for root in roots for folder in (root, root / "atlases")]
    sources = data.provenance.get(kind, ())
    return dict(_find(path, source["name"], source["digest"], searched) for source in sources)


def _find(path: StrPath, name: str, digest: str, folders: Sequence[Path]) -> tuple[Path, CubeFileError | None]:
    """Return the file of a name and digest, or one of the name with an error.

    Only a plain name is searched in folders, no path on any system.
    """
    plain = not set(name) & set("/\\:")
    candidates = [folder / name for folder in folders if plain and os.path.isfile(folder / name)]
    for candidate in candidates:
        if read_document(candidate).digest == digest:
            return candidate, None
    for shipped in shipped_atlases():
        if shipped.digest == digest:
            return shipped.path, None
    hint = "pass the folder that contains it, or build the cube again"
    if candidates:
        problem = f"its atlas '{name}' has changed ({candidates[0]})"
        return candidates[0], CubeFileError(problem, code="atlas-changed", path=path, hint=hint)
    raise CubeFileError(f"its atlas '{name}' was not found", code="atlas-not-found", path=path, hint=hint)


def _read_options(data: CubeData, path: StrPath) -> Options:
    if not data.provenance.get("options"):
        raise _missing_provenance(path)
    try:
        options = Options(**recorded_options(data.provenance["options"]))
        if is_camera_file(options.observer) and data.sensor.sensitivities is None:
            raise OptionError("the file of a camera without its sensitivities")
    except (TypeError, OptionError, UnknownNameError) as error:
        raise _unknown_options(error, path) from error
    if options.solver == CUSTOM:
        raise CubeFileError(
            "was built with a solver that was given as an object, which a cube cannot record",
            path=path,
            hint="build it again with that solver, or with a named one",
        )
    if options.dim != data.lattice.dim:
        raise CubeFileError(
            f"records dim {options.dim}, but has {pluralise(data.lattice.dim, 'node')} along each axis",
            path=path,
            hint=REBUILD,
        )
    return options


def _missing_provenance(path: StrPath) -> CubeFileError:
    return CubeFileError("does not record how it was built", path=path, hint=REBUILD)


def _unknown_options(error: Exception, path: StrPath) -> CubeFileError:
    return CubeFileError(f"records options that this version does not have ({error})", path=path, hint=REBUILD)
