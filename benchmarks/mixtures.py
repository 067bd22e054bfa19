"""Mixtures of two paints whose colours are known, ways of mixing their RGB, and
pictures of ramps.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from pathlib import Path

import numpy as np

from benchmarks import read_reference
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.srgb import decode, encode, parse_colour
from uplift.extras.pages.plots import plot_strips
from uplift.extras.paint.optics import average_areas, ramp
from uplift.extras.paint.pigments import Pigment, Scattering, from_opaque
from uplift.lookup.cube import Cube

RATIOS = np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])
"""Shares of the mixtures of paints in three bands."""
BLUES = ("ultramarine", "cobalt", "cerulean", "phthalo blue")

MixRgb = Callable[[Array, Array], Array]
"""From linear RGB (n, 2, 3) of paints and shares (n, 2) to linear RGB (n, 3)."""


@dataclass(frozen=True, eq=False)
class Mixtures:
    """Mixtures of two paints.

    ``paints`` (p, 3): linear RGB of the paints.
    ``pairs`` (n, 2): indices of the paints of each mixture.
    ``shares`` (n, 2): their shares.
    ``expected`` (n, 3): linear RGB of the mixtures.
    """

    paints: Array
    pairs: Indices
    shares: Array
    expected: Array

    @property
    def colours(self) -> Array:
        """Linear RGB (n, 2, 3) of both paints of each mixture."""
        return self.paints[self.pairs]

    @property
    def parts(self) -> Array:
        """Parts (n, p) of all paints."""
        parts = np.zeros((len(self.pairs), len(self.paints)))
        np.put_along_axis(parts, self.pairs, self.shares, axis=1)
        return parts

    def take(self, rows: Indices) -> "Mixtures":
        """Select some of the mixtures."""
        return replace(
            self,
            pairs=self.pairs[rows],
            shares=self.shares[rows],
            expected=self.expected[rows],
        )

    def errors(self, mix: MixRgb, sensor: Sensor) -> Array:
        """Return ΔE00 (n,) of the mixtures by a function."""
        mixed = np.clip(mix(self.colours, self.shares), 0, 1)
        return delta_e_rgb(sensor, self.expected, mixed)


def mixture_sets() -> dict[str, Mixtures]:
    """Return all sets of mixtures by name."""
    return {
        "acrylics": acrylics(),
        "blues": acrylics(BLUES, "yellow"),
        "watercolours": three_bands("curtis1997"),
        "photographed": three_bands("lindemeier2020"),
        "mixbox": published("mixbox"),
        "coloraide": published("coloraide"),
    }


def acrylics(first: tuple[str, ...] = ("",), second: str = "") -> Mixtures:
    """Return the mixtures of paint_mixtures.csv.

    Only those of a paint whose name starts with one of ``first`` with a paint whose
    name ends in ``second``; by default all.
    """
    rows = read_reference("paint_mixtures.csv")
    paints = [row for row in rows if row["first"] == row["second"]]
    kept = []
    for row in rows:
        name, other = row["first"], row["second"]
        is_kept = (name.startswith(first) and other.endswith(second)) or (
            other.startswith(first) and name.endswith(second)
        )
        if name != other and is_kept:
            kept.append(row)
    numbers = {paint["first"]: index for index, paint in enumerate(paints)}
    pairs = [(numbers[row["first"]], numbers[row["second"]]) for row in kept]
    return Mixtures(
        _columns(paints, "rgb"), np.array(pairs), _shares(kept), _columns(kept, "rgb")
    )


def three_bands(name: str) -> Mixtures:
    """Return the mixtures of all pairs of a set of paints_rgb.csv, whose three bands
    are taken as linear RGB.
    """
    rows = [row for row in read_reference("paints_rgb.csv") if row["set"] == name]
    K = _columns(rows, ("Kr", "Kg", "Kb"))
    S = _columns(rows, ("Sr", "Sg", "Sb"))
    pairs = np.array(list(itertools.combinations(range(len(K)), 2)))
    mixtures = [
        Pigment(K[pairs], S[pairs]).mix(ratio).opaque_reflectance() for ratio in RATIOS
    ]
    return Mixtures(
        Pigment(K, S).opaque_reflectance(),
        np.concatenate([pairs] * len(RATIOS)),
        np.repeat(RATIOS, len(pairs), axis=0),
        np.concatenate(mixtures),
    )


def published(tool: str) -> Mixtures:
    """Return the mixtures that a tool publishes (published_mixtures.csv)."""
    rows = read_reference("published_mixtures.csv")
    kept = [row for row in rows if row["tool"] == tool]
    paints = [linear(row["first"], row["second"]) for row in kept]
    expected = linear(*(row["mixture"] for row in kept))
    return of_pairs(np.array(paints), _shares(kept), expected)


def of_pairs(colours: Array, shares: Array, expected: Array) -> Mixtures:
    """Return mixtures of pairs (n, 2, 3) of linear RGB by their shares (n, 2)."""
    pairs = np.arange(2 * len(colours)).reshape(-1, 2)
    return Mixtures(colours.reshape(-1, 3), pairs, shares, expected)


def linear(*codes: str) -> Array:
    """Return linear RGB (n, 3) of colours such as '#fcd200'."""
    return decode(np.array([parse_colour(code).codes for code in codes]) / 255)


def _columns(rows: list[dict[str, str]], names: Sequence[str]) -> Array:
    return np.array(list(map(itemgetter(*names), rows)), float)


def _shares(rows: list[dict[str, str]]) -> Array:
    share = np.array([float(row["share"]) for row in rows])
    return np.stack([1 - share, share], axis=1)


def by_spectra(cube: Cube, rule: Scattering) -> MixRgb:
    """Return a function that mixes as ``uplift paints mix``, with a rule for S."""

    def mix(rgb: Array, shares: Array) -> Array:
        paints = from_opaque(cube.reflectance(rgb), rule)
        return cube.data.sensor.rgb(paints.mix(shares).opaque_reflectance())

    return mix


def mean_of_codes(rgb: Array, shares: Array) -> Array:
    """Mix codes of the curve of sRGB."""
    return decode(average_areas(encode(rgb), shares))


def ramp_between(first: str, second: str, mix: MixRgb, steps: int) -> Array:
    """Return linear RGB (steps, 3) from one colour to another."""
    shares = ramp(np.ones(2), steps)
    ends = linear(first, second)
    return mix(np.broadcast_to(ends, (steps, *ends.shape)), shares)


def draw_ramps(ramps: Mapping[str, Array], path: Path) -> None:
    """Write a strip for each ramp, linear sRGB (n, 3), by title."""
    strips = {title: encode(rgb) for title, rgb in ramps.items()}
    plot_strips(strips, path, force=True)
