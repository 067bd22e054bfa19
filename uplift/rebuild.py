"""A cube made again from what it recorded of its making."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from uplift.atlas import Spectra, read_atlas
from uplift.atlas.document import read_document
from uplift.errors import CubeFileError, OptionError, UnknownNameError, UpliftWarning
from uplift.fit import Watch
from uplift.lookup import Cube
from uplift.pipeline import build

StrPath = str | os.PathLike[str]


def rebuild(
    stored: Cube, path: StrPath, folders: Iterable[StrPath] = (), *, watch: Watch = lambda done: None
) -> Cube:
    """The cube that this version makes from the options recorded in ``stored``, read from ``path``.

    Its atlases are looked for by name and digest in ``folders``, beside the cube, in the working folder,
    and in the ``atlases`` folders in and beside these.

    Raises
    ------
    CubeFileError : the cube does not say how it was made, or an atlas is not to be found.
    """
    provenance = stored.data.provenance
    try:
        options = dict(provenance["options"])
        options["lights"] = tuple(options["lights"])
        sources = [(str(source["name"]), str(source["digest"])) for source in provenance["atlases"]]
    except (KeyError, TypeError, ValueError) as error:
        raise CubeFileError("does not say how it was made", path=path, remedy="build it anew") from error
    atlas = _read_all(path, sources, _places(path, folders))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)  # the first build has said it all
        try:
            return build(atlas, watch=watch, **options)
        except (TypeError, OptionError, UnknownNameError) as error:
            problem = f"was made with options unknown here ({error})"
            raise CubeFileError(problem, path=path, remedy="build it anew") from error


def _places(path: StrPath, folders: Iterable[StrPath]) -> list[Path]:
    roots = [*(Path(folder) for folder in folders), Path(path).resolve().parent, Path.cwd()]
    return [place for root in roots for place in (root, root / "atlases", root.parent / "atlases")]


def _read_all(path: StrPath, sources: Sequence[tuple[str, str]], places: Sequence[Path]) -> Spectra | None:
    if not sources:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return read_atlas(*(_find(path, name, digest, places) for name, digest in sources))


def _find(path: StrPath, name: str, digest: str, places: Sequence[Path]) -> Path:
    candidates = [place / name for place in places if (place / name).is_file()]
    for candidate in candidates:
        if read_document(candidate).digest == digest:
            return candidate
    problem = f"its atlas '{name}' " + (
        f"has changed ({candidates[0]})" if candidates else "is not to be found"
    )
    raise CubeFileError(problem, path=path, remedy="name the folder with --atlas-dir, or build the cube anew")
