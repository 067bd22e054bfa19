"""A cube against its own rebuilding: does this version still make what was stored? (`uplift check`)"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.atlas import Spectra, read_atlas
from uplift.atlas.document import read_document
from uplift.cube import CubeData
from uplift.difference import delta_e_2000, lab
from uplift.errors import CubeFileError, UpliftWarning
from uplift.fit import Watch
from uplift.lookup import Cube, load
from uplift.observer import light
from uplift.pipeline import build
from uplift.sensor import Array

LIGHTS = ("D65", "A", "FL11")

LIMITS = {"rgb": 1e-5, "spectra_max": 1e-3, "spectra_rms": 1e-5} | {
    f"delta_e_{name}": 0.01 for name in LIGHTS
}
"""What may differ between machines: rounding travels through the rounds of growth, but not far."""


@dataclass(frozen=True)
class Comparison:
    """A stored cube and its rebuilding. ``measures`` as in `LIMITS`; ``counts`` of status, stored and rebuilt."""

    path: Path
    measures: dict[str, float]
    stored_counts: dict[str, int]
    rebuilt_counts: dict[str, int]

    @property
    def failures(self) -> tuple[str, ...]:
        """What is over its limit (NaN is), or differs at all where nothing may."""
        over = [name for name, value in self.measures.items() if not value <= LIMITS[name]]
        return (*over, *(["status"] if self.stored_counts != self.rebuilt_counts else []))


def check(
    path: str | Path, folders: Iterable[str | Path] = (), watch: Watch = lambda done: None
) -> Comparison:
    """Rebuild a stored cube from its recorded options and compare.

    The atlases are looked for by name and digest in ``folders``, beside the cube, in the working folder,
    and in the ``atlases`` folders of these.

    Raises
    ------
    CubeFileError : no cube, a cube that does not say how it was made, or an atlas that is not to be found.
    """
    stored = load(path)
    return compare(Path(path), stored.data, rebuild(path, stored, folders, watch).data)


def rebuild(
    path: str | Path, stored: Cube, folders: Iterable[str | Path] = (), watch: Watch = lambda done: None
) -> Cube:
    """The cube that this version makes from the options recorded in ``stored``. Raises as `check`."""
    provenance = stored.data.provenance
    try:
        options = dict(provenance["options"])
        options["lights"] = tuple(options["lights"])
        sources = [(str(source["name"]), str(source["digest"])) for source in provenance["atlases"]]
    except (KeyError, TypeError) as error:
        raise CubeFileError("does not say how it was made", path=path, remedy="rebuild it by hand") from error
    if stored.data.atlas.names and not sources:
        raise CubeFileError(
            "was built from spectra that no file holds", path=path, remedy="check it in Python"
        )
    atlas = _find_all(path, sources, [Path(folder) for folder in folders])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        try:
            return build(atlas, watch=watch, **options)
        except TypeError as error:
            raise CubeFileError(f"was made with options unknown here ({error})", path=path) from error


def compare(path: Path, stored: CubeData, rebuilt: CubeData) -> Comparison:
    """Raises `CubeFileError` where the two have no points in common."""
    if not np.array_equal(stored.lattice.nodes, rebuilt.lattice.nodes):
        raise CubeFileError(
            "has another lattice than its options say", path=path, remedy="rebuild it with --update"
        )
    first, second = _spectra(stored), _spectra(rebuilt)
    difference = np.abs(first - second)
    measures = {
        "rgb": float(np.abs(stored.rgb.astype(float) - rebuilt.rgb).max()),
        "spectra_max": float(difference.max()),
        "spectra_rms": float(np.sqrt((difference**2).mean())),
    }
    for name in LIGHTS:
        measures[f"delta_e_{name}"] = _largest_delta_e(name, stored.sensor.observer, first, second)
    return Comparison(path, measures, stored.counts(), rebuilt.counts())


def _spectra(data: CubeData) -> Array:
    """(n, N) spectra of all lattice points on the sensor's wavelengths."""
    multipliers = data.model.from_storage(data.coefficients)
    return np.asarray(data.model.squash(multipliers @ data.model.basis(data.sensor.wavelengths).T))


def _largest_delta_e(name: str, observer: str, first: Array, second: Array) -> float:
    lit = light(name, observer)
    labs = [lab(spectra @ lit.xyz.T, lit.white) for spectra in (first, second)]
    return float(delta_e_2000(*labs).max())


def _find_all(
    path: str | Path, sources: Sequence[tuple[str, str]], folders: Sequence[Path]
) -> Spectra | None:
    if not sources:
        return None
    roots = [*folders, Path(path).resolve().parent, Path.cwd()]
    places = [place for root in roots for place in (root, root / "atlases", root.parent / "atlases")]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        found = [_find(path, name, digest, places) for name, digest in sources]
        return read_atlas(*found)


def _find(path: str | Path, name: str, digest: str, places: Sequence[Path]) -> Path:
    candidates = [place / name for place in places if (place / name).is_file()]
    for candidate in candidates:
        if read_document(candidate).digest == digest:
            return candidate
    problem = f"its atlas '{name}' " + (
        f"has changed ({candidates[0]})" if candidates else "is not to be found"
    )
    raise CubeFileError(problem, path=path, remedy="name its folder with --atlas-dir, or rebuild the cube")
