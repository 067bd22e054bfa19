"""Repeat a build from the options and atlas files that a cube recorded."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from uplift.colorimetry.camera import Camera
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Mask, StrPath
from uplift.common.errors import CubeFileError, LookError, OptionError, UnknownNameError, UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.cube import CubeData
from uplift.lattice import EntryBoxes
from uplift.lookup import Cube
from uplift.pipeline.build_cube import build
from uplift.pipeline.looks import recorded_looks
from uplift.pipeline.options import CUSTOM, Options, recorded_options
from uplift.pipeline.provenance import REBUILD, missing_provenance, recorded_atlas, recorded_libraries


@dataclass(frozen=True, eq=False)
class StoredScene:
    """The scene of a cube that was built for images: its present points replace the images.

    Parameters
    ----------
    data : CubeData
        A sparse cube.
    """

    data: CubeData

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Return the points that are present in the cube; see `SceneLike`."""
        dim = self.data.lattice.dim
        if dim != boxes.lattice.dim:
            raise OptionError(
                f"the points of a stored scene need dim {dim}, got {boxes.lattice.dim}",
                code="scene-dim-mismatch",
            )
        return self.data.points.present

    def describe(self) -> list[dict[str, Any]]:
        """Return the sources that the cube recorded; see `SceneLike`."""
        return list(self.data.provenance["scene"])


def rebuild(
    stored: Cube,
    path: StrPath,
    folders: Iterable[StrPath] = (),
    *,
    progress: ProgressCallback = ignore_progress,
) -> Cube:
    """Build a cube again with the options that it recorded. Warnings of the first build are not repeated.

    Parameters
    ----------
    stored : Cube
        The cube.
    path : path-like
        File that ``stored`` was read from.
    folders : iterable of path-like, optional
        Folders to search for atlas files first; see `recorded_atlas`.
    progress : callable, optional
        Called with `Progress` events; see `uplift.build`.

    Returns
    -------
    Cube
        The new cube.

    Raises
    ------
    CubeFileError
        The cube does not record its options, was filled from another cube, or an atlas file is missing or changed.
    """
    options = _recorded_options(stored.data, path)
    if "filled" in stored.data.provenance:
        raise CubeFileError(
            "was filled from another cube and cannot be rebuilt",
            code="cube-filled",
            path=path,
            hint="rebuild the cube that was filled",
        )
    folders = tuple(folders)
    atlas = recorded_atlas(stored.data, path, folders)
    library = recorded_libraries(stored.data, path, folders)
    scene = StoredScene(stored.data) if "scene" in stored.data.provenance else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        try:
            given = asdict(options) | _recorded_camera(stored.data.sensor)
            looks = recorded_looks(stored.data.provenance)
            return build(atlas, library=library, looks=looks, scene=scene, progress=progress, **given)
        except (LookError, OptionError, UnknownNameError) as error:
            raise _unknown_options(error, path) from error


def _recorded_camera(sensor: Sensor) -> dict[str, Camera]:
    """Return the option that has the sensitivities of a cube of a camera."""
    if sensor.sensitivities is None:
        return {}
    return {"observer": Camera(sensor.space, sensor.wavelengths, sensor.sensitivities)}


def _recorded_options(data: CubeData, path: StrPath) -> Options:
    if not data.provenance.get("options"):
        raise missing_provenance(path)
    try:
        options = Options(**recorded_options(data.provenance["options"]))
    except (TypeError, OptionError, UnknownNameError) as error:
        raise _unknown_options(error, path) from error
    if options.solver == CUSTOM:
        raise CubeFileError(
            "was built with a solver that was given as an object, which a cube cannot record",
            code="custom-solver",
            path=path,
            hint="build it again with that solver, or with a named one",
        )
    if options.dim != data.lattice.dim:
        raise CubeFileError(
            f"records dim {options.dim}, but has {data.lattice.dim} nodes along each axis",
            code="lattice-mismatch",
            path=path,
            hint=REBUILD,
        )
    return options


def _unknown_options(error: Exception, path: StrPath) -> CubeFileError:
    problem = f"records options that this version does not have ({error})"
    return CubeFileError(problem, code="unknown-recorded-options", path=path, hint=REBUILD)
