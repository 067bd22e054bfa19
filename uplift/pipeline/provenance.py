"""The measurements behind a cube, found again by what it recorded of them: names and digests."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from uplift.atlas import Atlas, read_atlas
from uplift.atlas.document import read_document
from uplift.common.arrays import StrPath
from uplift.common.errors import CubeFileError, UpliftWarning
from uplift.cube import CubeData


def recorded_atlas(data: CubeData, path: StrPath, folders: Iterable[StrPath] = ()) -> Atlas | None:
    """The atlas that the cube read from ``path`` was built from; None where it was built without.

    Its files are looked for by name and digest in ``folders``, beside the cube, in the working folder, and
    in the ``atlases`` folders in and beside these. What the first build warned of is not said again.

    Raises
    ------
    CubeFileError : the cube does not say what it was built from, or a file is not to be found.
    """
    try:
        sources = [(str(source["name"]), str(source["digest"])) for source in data.provenance["atlases"]]
    except (KeyError, TypeError) as error:
        raise missing_provenance(path) from error
    return _read_all(path, sources, _places(path, folders))


def missing_provenance(path: StrPath) -> CubeFileError:
    """The error for a cube that did not record its making."""
    return CubeFileError("does not say how it was made", path=path, hint="build it anew")


def _places(path: StrPath, folders: Iterable[StrPath]) -> list[Path]:
    roots = [*(Path(folder) for folder in folders), Path(path).resolve().parent, Path.cwd()]
    return [place for root in roots for place in (root, root / "atlases", root.parent / "atlases")]


def _read_all(path: StrPath, sources: Sequence[tuple[str, str]], places: Sequence[Path]) -> Atlas | None:
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
    raise CubeFileError(problem, path=path, hint="name the folder with --atlas-dir, or build the cube anew")
