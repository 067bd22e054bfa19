"""Measured and published mixtures of two colours, from tests/reference: all in linear RGB."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from benchmarks.record import ROOT
from uplift.common.arrays import Array
from uplift.design.mixing.criteria import SHARES
from uplift.design.mixing.pigments import Pigment
from uplift.lookup import Cube

FOLDER = ROOT / "tests" / "reference"
BLUES = ("ultramarine", "cobalt", "cerulean", "phthalo blue")


@dataclass(frozen=True, eq=False)
class Mixtures:
    """Colours in linear RGB of n mixtures of two paints.

    Parameters
    ----------
    paints : ndarray of shape (p, 3)
        Colours of the paints.
    pairs : ndarray of int, shape (n, 2)
        Indices of the paints of each mixture.
    shares : ndarray of shape (n, 2)
        Their shares.
    expected : ndarray of shape (n, 3)
        Measured colours.
    """

    paints: Array
    pairs: Array
    shares: Array
    expected: Array

    @property
    def components(self) -> Array:
        """Colours (n, 2, 3) of both paints of each mixture."""
        return np.asarray(self.paints[self.pairs])


def acrylics(first: tuple[str, ...] = (), second: str = "") -> Mixtures:
    """Return the mixtures of paint_mixtures.csv.

    Only those of a paint whose name starts with one of ``first`` with a paint whose name ends in ``second``; by default
    all.
    """

    def wanted(one: str, other: str) -> bool:
        return (not first or one.startswith(first)) and other.endswith(second)

    table = _rows("paint_mixtures.csv")
    masstones = {row[0]: [float(x) for x in row[3:]] for row in table if row[0] == row[1]}
    index = {name: number for number, name in enumerate(masstones)}
    kept = [row for row in table if row[0] != row[1] and (wanted(*row[:2]) or wanted(row[1], row[0]))]
    return Mixtures(
        np.array(list(masstones.values())),
        np.array([[index[row[0]], index[row[1]]] for row in kept]),
        _shares([row[2] for row in kept]),
        np.array([[float(x) for x in row[3:]] for row in kept]),
    )


def three_bands(name: str) -> Mixtures:
    """Return the mixtures of all pairs of a set of paints_rgb.csv, whose three bands are taken as linear RGB."""
    values = np.array([row[1:] for row in _rows("paints_rgb.csv") if row[0] == name], dtype=float)
    K, S = values[:, :3], values[:, 3:]
    pairs = np.array(list(itertools.combinations(range(len(K)), 2)))
    mixtures = [Pigment(K[pairs], S[pairs]).mix(share).opaque_reflectance() for share in SHARES]
    return Mixtures(
        Pigment(K, S).opaque_reflectance(),
        np.concatenate([pairs] * len(SHARES)),
        np.repeat(SHARES, len(pairs), axis=0),
        np.concatenate(mixtures),
    )


def published(tool: str, cube: Cube) -> Mixtures:
    """Return the mixtures that a tool publishes (published_mixtures.csv)."""
    kept = [row for row in _rows("published_mixtures.csv") if row[0] == tool]
    linear = cube.decode(np.array([[codes(row[column]) for column in (1, 2, 4)] for row in kept]))
    pairs = np.arange(2 * len(kept)).reshape(-1, 2)
    return Mixtures(linear[:, :2].reshape(-1, 3), pairs, _shares([row[3] for row in kept]), linear[:, 2])


def codes(text: str) -> list[int]:
    """Return the three 8-bit codes of '#rrggbb'."""
    return [int(text[i : i + 2], 16) for i in (1, 3, 5)]


def _shares(second: list[str]) -> Array:
    share = np.array(second, dtype=float)
    return np.stack([1 - share, share], axis=1)


def _rows(name: str) -> list[list[str]]:
    """Return the fields of a table without comments and header."""
    lines = (FOLDER / name).read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines if not line.startswith("#")][1:]
