"""An atlas a little different: how much of the cube that changes, and how far from the entry."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.atlas import Atlas, Entry
from uplift.atlas.checks import HIGHEST, LOWEST
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.cube import CubeData
from uplift.models import reflectance
from uplift.pipeline import build

NOISE = 0.002
"""Repeatability of a spectrophotometer, standard deviation at every wavelength."""
MOVED_DELTA_E = 0.5
"""ΔE00 by which a lattice point has moved enough to count: half of what an eye can just tell."""


@dataclass(frozen=True, eq=False)
class Change:
    """What a change of the atlas does to all lattice points.

    Parameters
    ----------
    what : the change, in words.
    rms, delta_e : (n,) of the spectra before and after: rms over wavelength, ΔE00 under a light.
    rgb_apart, lab_apart : (n,) distance from the entry that changed, from where it was or is, in linear RGB and ΔE*ab;
        empty where all entries changed.
    """

    what: str
    rms: Array
    delta_e: Array
    rgb_apart: Array
    lab_apart: Array

    @property
    def moved(self) -> float:
        """Share of the lattice points that have `MOVED_DELTA_E`."""
        return float((self.delta_e > MOVED_DELTA_E).mean())

    def radius(self, apart: Array) -> float:
        """Largest distance (n,) of a point that moved; 0 where none has, NaN where all entries changed."""
        return float(np.max(apart[self.delta_e > MOVED_DELTA_E], initial=0)) if apart.size else float("nan")


@dataclass(frozen=True, eq=False)
class Baseline:
    """A cube before its atlas changes: its entries, what it holds, the spectra (n, N) of its lattice points."""

    entries: tuple[Entry, ...]
    data: CubeData
    spectra: Array
    light: Light
    options: Mapping[str, Any]


def build_baseline(spectra: Atlas, light: Light, **options: Any) -> Baseline:
    """Build the cube that changes are compared with; changes are ΔE00 under ``light``. Raises `UpliftError`."""
    data = _build(spectra.entries, options)
    entries = tuple(entry for entry in spectra.entries if entry.name in data.atlas.names)
    return Baseline(entries, data, _lattice(data), light, options)


def remove_entry(base: Baseline, name: str) -> Change:
    """Without an entry."""
    return _compare(base, f"{name} left out", [entry for entry in base.entries if entry.name != name], name)


def reverse_entry(base: Baseline, name: str) -> Change:
    """With an entry whose wavelengths were read from the wrong end."""
    entries = [
        replace(entry, values=entry.values[::-1]) if entry.name == name else entry for entry in base.entries
    ]
    return _compare(base, f"{name} wrong", entries, name)


def add_noise(base: Baseline, seed: int) -> Change:
    """With `NOISE` on every entry."""
    rng = np.random.default_rng(seed)

    def again(entry: Entry) -> Entry:
        return replace(
            entry, values=np.clip(entry.values + rng.normal(0, NOISE, len(entry.values)), LOWEST, HIGHEST)
        )

    return _compare(base, f"noise, draw {seed}", [again(entry) for entry in base.entries])


def _compare(base: Baseline, what: str, entries: Sequence[Entry], name: str | None = None) -> Change:
    data = _build(entries, base.options)
    after = _lattice(data)
    rms = np.sqrt(((after - base.spectra) ** 2).mean(axis=1))
    places = [
        one.atlas.rgb[one.atlas.names.index(name)] for one in (base.data, data) if name in one.atlas.names
    ]
    points, sensor = base.data.lattice.points, base.data.sensor
    rgb_apart, lab_apart = (
        _nearest(points, places),
        _nearest(rgb_to_lab(sensor, points), [rgb_to_lab(sensor, place) for place in places]),
    )
    return Change(what, rms, delta_e_spectra(base.light, base.spectra, after), rgb_apart, lab_apart)


def _nearest(points: Array, places: Sequence[Array]) -> Array:
    """Distance (n,) of points (n, 3) to the nearest place; nothing where there is none."""
    if not places:
        return np.zeros(0)
    return np.asarray(np.min([np.linalg.norm(points - place, axis=1) for place in places], axis=0))


def _build(entries: Sequence[Entry], options: Mapping[str, Any]) -> CubeData:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return build(Atlas(tuple(entries)), **options).data


def _lattice(data: CubeData) -> Array:
    return reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)
