"""A cube made again from what it recorded of its making."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from uplift.common.arrays import StrPath
from uplift.common.errors import CubeFileError, OptionError, UnknownNameError, UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.io.scene_colours import StoredScene
from uplift.lookup import Cube
from uplift.pipeline import build
from uplift.pipeline.provenance import missing_provenance, recorded_atlas


def rebuild(
    stored: Cube,
    path: StrPath,
    folders: Iterable[StrPath] = (),
    *,
    progress: ProgressCallback = ignore_progress,
) -> Cube:
    """The cube that this version makes from the options recorded in ``stored``, read from ``path``.

    Its atlases are looked for as `recorded_atlas` does; of a scene the stored points tell all.

    Raises
    ------
    CubeFileError : the cube does not say how it was made, or an atlas is not to be found.
    """
    try:
        options = dict(stored.data.provenance["options"])
        options["lights"] = tuple(options["lights"])
    except (KeyError, TypeError, ValueError) as error:
        raise missing_provenance(path) from error
    if "filled" in stored.data.provenance:
        raise CubeFileError("is filled from another cube", path=path, hint="check it as it was before")
    atlas = recorded_atlas(stored.data, path, folders)
    scene = StoredScene(stored.data) if "scene" in stored.data.provenance else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)  # the first build has said it all
        try:
            return build(atlas, scene=scene, progress=progress, **options)
        except (TypeError, OptionError, UnknownNameError) as error:
            problem = f"was made with options unknown here ({error})"
            raise CubeFileError(problem, path=path, hint="build it anew") from error
