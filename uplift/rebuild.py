"""A cube made again from what it recorded of its making."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from uplift.errors import CubeFileError, OptionError, UnknownNameError, UpliftWarning
from uplift.fit import Watch
from uplift.lookup import Cube
from uplift.pipeline import build
from uplift.provenance import StrPath, recorded_atlas, untold


def rebuild(
    stored: Cube, path: StrPath, folders: Iterable[StrPath] = (), *, watch: Watch = lambda done: None
) -> Cube:
    """The cube that this version makes from the options recorded in ``stored``, read from ``path``.

    Its atlases are looked for as `recorded_atlas` does.

    Raises
    ------
    CubeFileError : the cube does not say how it was made, or an atlas is not to be found.
    """
    try:
        options = dict(stored.data.provenance["options"])
        options["lights"] = tuple(options["lights"])
    except (KeyError, TypeError, ValueError) as error:
        raise untold(path) from error
    atlas = recorded_atlas(stored.data, path, folders)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)  # the first build has said it all
        try:
            return build(atlas, watch=watch, **options)
        except (TypeError, OptionError, UnknownNameError) as error:
            problem = f"was made with options unknown here ({error})"
            raise CubeFileError(problem, path=path, remedy="build it anew") from error
