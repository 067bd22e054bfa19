"""The content of an emission table, and the file that stores it (docs/cube-file.md,
"Emission tables").
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, distances
from uplift.common.text import pluralise
from uplift.cube.container import (
    RANGE,
    Kind,
    Stored,
    Tensors,
    check_arrays,
    check_metadata,
    check_wavelengths,
    content_digest,
    load,
    require,
    save,
)
from uplift.cube.decode import MAX_CONDITION
from uplift.cube.schema import ENTRIES, PROVENANCE
from uplift.extras.emission.discs import LampEntries
from uplift.extras.emission.lattice import ChromaticityLattice, chromaticity

VERSION = 1
KIND = Kind(
    "uplift emission table",
    (VERSION,),
    "emission table",
    foreign="not-an-emission-table",
)
MAX_OFFSET = 1e-4
"""Largest distance in u′v′ between a stored spectrum and its place; single precision
keeps 1e-6.
"""
MAX_RADIUS = 0.1
"""Largest radius of a disc in u′v′."""
ARRAYS = {
    "white": Stored("2", low=0),
    "knots": Stored("K 2", low=0),
    "rings": Stored("R", low=0),
    "spectra": Stored("K R N", ("float32",), low=0),
    "error": Stored("K R", ("float32",), low=0),
    "wavelengths": Stored("N", low=RANGE[0], high=RANGE[1]),
    "cmfs": Stored("N 3"),
    "rgb_to_xyz": Stored("3 3"),
    "entries.uv": Stored("E 2", low=0),
    "entries.spectra": Stored("E N", low=0),
    "entries.radius": Stored("E", low=0),
}
METADATA = {
    "format": str,
    "version": int,
    "space": str,
    "observer": str,
    "entries": ENTRIES,
    "provenance": PROVENANCE,
}


@dataclass(frozen=True, eq=False, repr=False)
class EmissionData:
    """Content of an emission table: a lattice of K knots and R rings, spectra at N
    wavelengths, and lamps.

    Powers are relative to the equal-energy light of luminance 1, whose power is 1 at
    every wavelength.
    """

    space: str
    """RGB space of queries."""
    observer: str
    """Colour-matching functions."""
    rgb_to_xyz: Array
    """(3, 3) from linear RGB to XYZ; white has Y = 1."""
    wavelengths: Array
    """(N,) wavelengths in nm, evenly spaced, ascending."""
    cmfs: Array
    """(N, 3) colour-matching functions."""
    lattice: ChromaticityLattice
    spectra: NDArray[np.float32]
    """(K, R, N) power of unit X + 15 Y + 3 Z at the nodes."""
    error: NDArray[np.float32]
    """(K, R) expected ΔE00 of surfaces lit by the answer instead of a measured lamp of
    the same chromaticity.
    """
    entries: LampEntries
    """Lamps that are exact."""
    provenance: Mapping[str, Any]
    """Version, options and files of the build."""

    def __repr__(self) -> str:
        lamps = pluralise(len(self.entries.names), "lamp")
        knots, rings = self.lattice.shape
        wavelengths = pluralise(len(self.wavelengths), "wavelength")
        return (
            f"EmissionData({knots} × {rings} nodes, {wavelengths}, {self.space}, "
            f"{lamps})"
        )

    @cached_property
    def radiometry(self) -> Array:
        """(N, 3) from power to XYZ: XYZ of a power s is Σ s cmfs / Σ ȳ."""
        return self.cmfs / self.cmfs[:, 1].sum()


def write_emission(
    data: EmissionData, path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Write an emission table, atomically; `OutputError` if the file exists and `force`
    is false, or cannot be written.

    The new file is read back before it replaces an existing one.
    """
    save((_tensors(data), _metadata(data)), path, KIND, read_emission, force=force)


def read_emission(path: str | os.PathLike[str]) -> EmissionData:
    """Read an emission table, and check its digest and all its content.

    `CubeFileError` if the file is missing, damaged, or not an emission table of this
    version.
    """
    return load(Path(path), KIND, _decode)


def emission_digest(data: EmissionData) -> str:
    """SHA-256 in hexadecimal of a table. Tables with equal digests give equal answers,
    bit for bit.
    """
    return content_digest(_tensors(data), _metadata(data))


def _tensors(data: EmissionData) -> Tensors:
    places = {name: f"lattice.{name}" for name in ("white", "knots", "rings")}
    arrays = {name: attrgetter(places.get(name, name))(data) for name in ARRAYS}
    return {
        name: np.ascontiguousarray(arrays[name], dtype=stored.types[0])
        for name, stored in ARRAYS.items()
    }


def _metadata(data: EmissionData) -> dict[str, Any]:
    return {
        "format": KIND.format,
        "version": VERSION,
        "space": data.space,
        "observer": data.observer,
        "entries": list(data.entries.names),
        "provenance": dict(data.provenance),
    }


def _decode(tensors: Tensors, metadata: Mapping[str, Any]) -> EmissionData:
    check_metadata(metadata, METADATA)
    names = tuple(metadata["entries"])
    require(len(set(names)) == len(names), "the names of entries must be unique")
    require(set(tensors) == set(ARRAYS), f"the arrays must be {', '.join(ARRAYS)}")
    sizes = {
        "K": len(tensors["knots"]),
        "R": tensors["rings"].size,
        "N": tensors["wavelengths"].size,
    }
    check_arrays(tensors, ARRAYS, {**sizes, "E": len(names)})
    data = EmissionData(
        space=metadata["space"],
        observer=metadata["observer"],
        lattice=ChromaticityLattice(
            tensors["white"], tensors["knots"], tensors["rings"]
        ),
        entries=LampEntries(
            names, *(tensors[f"entries.{name}"] for name in ("uv", "spectra", "radius"))
        ),
        provenance=metadata["provenance"],
        **{
            name: tensors[name]
            for name in ("rgb_to_xyz", "wavelengths", "cmfs", "spectra", "error")
        },
    )
    _check(data)
    return data


def _check(data: EmissionData) -> None:
    """Check that the arrays belong together."""
    check_wavelengths(data.wavelengths)
    require(
        float(data.cmfs[:, 1].sum()) > 0, "the colour-matching functions must respond"
    )
    condition = float(np.linalg.cond(data.rgb_to_xyz))
    require(condition < MAX_CONDITION, "the RGB space must have three primaries")
    places = (
        (data.spectra, data.lattice.nodes),
        (data.entries.spectra, data.entries.uv),
    )
    for spectra, uv in places:
        xyz = spectra @ data.radiometry
        unit = np.abs(xyz @ (1.0, 15.0, 3.0) - 1).max(initial=0) <= MAX_OFFSET
        there = unit and np.abs(chromaticity(xyz) - uv).max(initial=0) <= MAX_OFFSET
        require(bool(there), "every spectrum must have the chromaticity of its place")
    realisable = bool(data.lattice.contains(data.entries.uv).all())
    require(realisable, "lamps must be realisable")
    uv = data.entries.uv
    radius = data.entries.radius
    apart = distances(uv, uv) - radius[:, None] - radius
    overlap = bool((apart[~np.eye(len(uv), dtype=bool)] < -MAX_OFFSET).any())
    valid = not overlap and bool((radius <= MAX_RADIUS).all())
    require(valid, f"discs must not overlap, and have radii up to {MAX_RADIUS:g}")


def summarise(data: EmissionData) -> dict[str, Any]:
    """Summarise an emission table, most general facts first."""
    knots, rings = data.lattice.shape
    first, second = data.wavelengths[:2].tolist()
    return {
        "format": KIND.format,
        "knots": knots,
        "rings": rings,
        "nodes": knots * rings,
        "space": data.space,
        "observer": data.observer,
        "wavelengths": {
            "first": first,
            "last": float(data.wavelengths[-1]),
            "step": second - first,
        },
        "mean_expected_error": float(data.error.mean(dtype=np.float64)),
        "largest_expected_error": float(data.error.max()),
        "lamps": list(data.entries.names),
        "provenance": dict(data.provenance),
        "digest": emission_digest(data),
    }
