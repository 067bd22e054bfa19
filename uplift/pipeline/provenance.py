"""Find the atlas files of a cube by the names and digests that it recorded."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path

from uplift.atlas import Atlas, Source, merge, read_atlas, shipped_atlases
from uplift.atlas.document import read_document
from uplift.common.arrays import StrPath
from uplift.common.errors import CubeFileError, UpliftWarning
from uplift.cube import CubeData

REBUILD = "build the cube again"
"""Hint for cubes whose build cannot be repeated."""
MAX_FILE_NAME = 255


def recorded_atlas(data: CubeData, path: StrPath, folders: Iterable[StrPath] = ()) -> Atlas | None:
    """Read the atlas that a cube was built from. Warnings of the first build are not repeated.

    The files are searched by name and digest in ``folders``, in the folder of the cube, and in folders ``atlases`` in
    these, and by digest among the shipped atlases. A recorded name never opens a file elsewhere.

    Parameters
    ----------
    data : CubeData
        The cube.
    path : path-like
        File that ``data`` was read from.
    folders : iterable of path-like, optional
        Folders to search first.

    Returns
    -------
    Atlas or None
        The measured spectra; None for a cube without an atlas.

    Raises
    ------
    CubeFileError
        The cube does not record its atlas, or a file is missing or has changed.
    """
    if "atlases" not in data.provenance:
        raise missing_provenance(path)
    sources = data.provenance["atlases"]
    if not sources:
        return None
    candidates = _search_path(path, folders)
    files = [_find(path, source["name"], source["digest"], candidates) for source in sources]
    scales = [source.get("measured", "auto") for source in sources]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return merge(read_atlas(file, measured=scale) for file, scale in zip(files, scales, strict=True))


def describe_source(source: Source) -> dict[str, str]:
    """Return what a cube records of an atlas file, so that `recorded_atlas` finds and reads it again.

    Parameters
    ----------
    source : Source
        The file.

    Returns
    -------
    dict
        Name and digest, and the scale of the values if the caller gave it.
    """
    scale = {} if source.measured == "auto" else {"measured": source.measured}
    return {"name": source.name, "digest": source.digest, **scale}


def recorded_libraries(data: CubeData, path: StrPath, folders: Iterable[StrPath] = ()) -> tuple[Path, ...]:
    """Find the libraries that shaped the prior of a cube, as `recorded_atlas` does its atlas.

    Parameters
    ----------
    data : CubeData
        The cube.
    path : path-like
        File that ``data`` was read from.
    folders : iterable of path-like, optional
        Folders to search first.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    CubeFileError
        A file is missing or has changed.
    """
    candidates = _search_path(path, folders)
    sources = data.provenance.get("libraries", ())
    return tuple(_find(path, source["name"], source["digest"], candidates) for source in sources)


def missing_provenance(path: StrPath) -> CubeFileError:
    """Make the error for a cube that does not record its options.

    Parameters
    ----------
    path : path-like
        The cube file.

    Returns
    -------
    CubeFileError
        The error to raise.
    """
    return CubeFileError("does not record how it was built", code="missing-provenance", path=path, hint=REBUILD)


def _search_path(path: StrPath, folders: Iterable[StrPath]) -> list[Path]:
    roots = [*map(Path, folders), Path(path).resolve().parent]
    return [folder for root in roots for folder in (root, root / "atlases")]


def _is_plain(name: str) -> bool:
    """Whether a name is that of a file in a folder, without a path on any system."""
    return not set(name) & set("/\\:\0") and name not in ("", ".", "..") and len(name) <= MAX_FILE_NAME


def _find(path: StrPath, name: str, digest: str, folders: Sequence[Path]) -> Path:
    candidates = [file for folder in folders if (file := folder / name).is_file()] if _is_plain(name) else []
    for candidate in candidates:
        if read_document(candidate).digest == digest:
            return candidate
    for shipped in shipped_atlases():
        if shipped.digest == digest:
            return shipped.path
    hint = "pass the folder that contains it, or build the cube again"
    if candidates:
        problem = f"its atlas '{name}' has changed ({candidates[0]})"
        raise CubeFileError(problem, code="atlas-changed", path=path, hint=hint)
    raise CubeFileError(f"its atlas '{name}' was not found", code="atlas-not-found", path=path, hint=hint)
