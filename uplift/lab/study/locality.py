"""Sensitivity of a cube to changes of its atlas: how much of the lattice changes, and how far from the entry."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.atlas import HIGHEST, LOWEST
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.cube import CubeData
from uplift.models import reflectance
from uplift.pipeline.build import build

NOISE = 0.002
"""Repeatability of a spectrophotometer: standard deviation of a reflectance."""
MOVED_DELTA_E = 0.5
"""ΔE00 above which a lattice point counts as moved: half of a just noticeable difference."""


@dataclass(frozen=True, eq=False)
class Change:
    """Effect of a change of the atlas on the n lattice points.

    Parameters
    ----------
    description : str
        The change.
    rms : ndarray, shape (n,)
        Change of the spectra, rms over wavelength.
    delta_e : ndarray, shape (n,)
        Change of the spectra, ΔE00 under a light.
    rgb_distance, lab_distance : ndarray, shape (n,)
        Distance in linear RGB and ΔE*ab from the nearer of the old and the new colour of the changed entry. Empty if
        all entries changed.
    """

    description: str
    rms: Array
    delta_e: Array
    rgb_distance: Array
    lab_distance: Array

    @property
    def moved(self) -> float:
        """Share of the lattice points that change by more than `MOVED_DELTA_E`."""
        return float((self.delta_e > MOVED_DELTA_E).mean())

    def radius(self, distance: Array) -> float:
        """Largest distance (n,) of a moved point; 0 if no point moved, NaN if all entries changed."""
        if not distance.size:
            return float("nan")
        return float(np.max(distance[self.delta_e > MOVED_DELTA_E], initial=0))


@dataclass(frozen=True, eq=False)
class Baseline:
    """A cube before its atlas changes.

    Parameters
    ----------
    entries : tuple of Entry
        Entries of the atlas that constrain the cube.
    data : CubeData
        The cube.
    spectra : ndarray, shape (n, N)
        Reflectances of the lattice points.
    light : Light
        Light of all ΔE00.
    options : mapping
        Build options.
    """

    entries: tuple[Entry, ...]
    data: CubeData
    spectra: Array
    light: Light
    options: Mapping[str, Any]


def build_baseline(atlas: Atlas, light: Light, **options: Any) -> Baseline:
    """Build the cube that changes are compared with. Raises `UpliftError`."""
    data = _build(atlas.entries, options)
    entries = tuple(entry for entry in atlas.entries if entry.name in data.atlas.names)
    return Baseline(entries, data, _lattice_spectra(data), light, options)


def remove_entry(base: Baseline, name: str) -> Change:
    """Rebuild without an entry."""
    remaining = [entry for entry in base.entries if entry.name != name]
    return _compare(base, f"{name} left out", remaining, name)


def reverse_entry(base: Baseline, name: str) -> Change:
    """Rebuild with the wavelengths of an entry in reverse order, as an example of a wrong measurement."""
    entries = [replace(entry, values=entry.values[::-1]) if entry.name == name else entry for entry in base.entries]
    return _compare(base, f"{name} wrong", entries, name)


def add_noise(base: Baseline, seed: int) -> Change:
    """Rebuild with `NOISE` added to every entry."""
    rng = np.random.default_rng(seed)

    def noisy(entry: Entry) -> Entry:
        values = entry.values + rng.normal(0, NOISE, len(entry.values))
        return replace(entry, values=np.clip(values, LOWEST, HIGHEST))

    return _compare(base, f"noise, draw {seed}", [noisy(entry) for entry in base.entries])


def _compare(base: Baseline, description: str, entries: Sequence[Entry], name: str | None = None) -> Change:
    data = _build(entries, base.options)
    after = _lattice_spectra(data)
    rms = np.sqrt(((after - base.spectra) ** 2).mean(axis=1))
    colours = [each.atlas.rgb[each.atlas.names.index(name)] for each in (base.data, data) if name in each.atlas.names]
    points, sensor = base.data.lattice.points, base.data.sensor
    return Change(
        description,
        rms,
        delta_e_spectra(base.light, base.spectra, after),
        _distance(points, colours),
        _distance(rgb_to_lab(sensor, points), [rgb_to_lab(sensor, colour) for colour in colours]),
    )


def _distance(points: Array, centres: Sequence[Array]) -> Array:
    """Distance (n,) of points (n, 3) to the nearest centre; empty without centres."""
    if not centres:
        return np.zeros(0)
    return np.asarray(np.min([np.linalg.norm(points - centre, axis=1) for centre in centres], axis=0))


def _build(entries: Sequence[Entry], options: Mapping[str, Any]) -> CubeData:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return build(Atlas(tuple(entries)), **options).data


def _lattice_spectra(data: CubeData) -> Array:
    return reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)
