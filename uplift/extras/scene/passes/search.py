"""Search of bands: centres and one width, by steps along one of them at a time.

Centres and widths are whole nanometres, and a step must lower the error by more than
rounding does, so the search ends at the same bands on every processor.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback
from uplift.extras.scene.passes.bands import Bands
from uplift.extras.scene.passes.decoding import Grams
from uplift.extras.scene.passes.light_paths import LightPaths

STEPS = (16, 8, 4, 2, 1)
"""Steps in nm, one after the other."""
MAX_SWEEPS = 6
"""Most sweeps over all centres with one step."""
MIN_GAIN = 1e-4
"""Least relative gain of a step that is taken."""
MIN_DISTANCE = 3
"""Least distance of centres in nm."""
MAX_SEARCHED_WIDTH = 40
"""Largest width in nm that is searched."""
MARGIN = 5
"""Distance in nm of centres from the ends of spectra."""
RANGES = ((400.0, 700.0), (410.0, 660.0), (415.0, 685.0), (430.0, 670.0))
"""Ranges in nm of the starts: the search ends in the nearest local minimum."""
START_WIDTHS = (4, 16)
"""Widths in nm of the starts."""
FLOOR = 0.05
"""Least numbers of a light, relative to its mean powers in the bands."""
FIRST_ROUNDS = 20
"""Rounds of the first fit of a start."""
ROUNDS = 6
"""Rounds of the fit of a step, which starts from that of its neighbour."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """Bands with the numbers (L, K) of the lights and the root mean square of ΔE00."""

    bands: Bands
    numbers: Array
    error: float


def band_powers(bands: Bands, powers: Array) -> Array:
    """Mean powers (L, K) of lights in each band, whose mean over the lights is 1: a
    start for their numbers.
    """
    means = np.maximum(powers @ bands.weights.T, 0)
    scale = means.mean(axis=0)
    return np.where(scale > 0, means / np.where(scale > 0, scale, 1), 1.0)


def _better(known: Candidate, trial: Candidate) -> Candidate:
    """Return a candidate, or another one that gains enough."""
    return trial if trial.error < known.error * (1 - MIN_GAIN) else known


@dataclass(frozen=True, eq=False)
class Search:
    """Candidates over the paths of a scene, of one ``width`` if it is given."""

    paths: LightPaths
    width: int | None = None

    def fit(
        self, bands: Bands, numbers: Array | None = None, rounds: int = FIRST_ROUNDS
    ) -> Candidate:
        """Fit bands, from the numbers (L, K) of similar ones if there are any."""
        powers = band_powers(bands, self.paths.powers)
        start = powers if numbers is None else numbers
        grams = Grams.of(self.paths, self.paths.numbers(bands.weights))
        _, numbers, error = grams.alternate(start, FLOOR * powers, rounds)
        return Candidate(bands, numbers, error)

    def best(self, count: int, progress: ProgressCallback) -> Candidate:
        """Return the best of ``count`` bands from all starts."""
        starts = list(self._starts(count))
        candidates = []
        for done, start in enumerate(starts):
            progress(Progress("starts", done, len(starts)))
            candidates.append(self.descend(self.fit(start)))
        progress(Progress("starts", len(starts), len(starts)))
        return reduce(_better, candidates)

    def descend(self, candidate: Candidate) -> Candidate:
        """Take steps of decreasing length as long as they lower the error."""
        for step in STEPS:
            for _ in range(MAX_SWEEPS):
                moved = self._sweep(candidate, step)
                if moved is candidate:
                    break
                candidate = moved
        return candidate

    def _sweep(self, candidate: Candidate, step: int) -> Candidate:
        for row in range(len(candidate.bands) + 1):
            for sign in (-1, 1):
                bands = self._moved(candidate.bands, row, sign * step)
                if bands is None:
                    continue
                trial = self.fit(bands, candidate.numbers, ROUNDS)
                candidate = _better(candidate, trial)
        return candidate

    def _moved(self, bands: Bands, row: int, step: int) -> Bands | None:
        """Return bands of which a centre is moved, or the width, whose row is K; None
        if they are not allowed.
        """
        if row == len(bands):
            half = int(np.sign(step)) * max(abs(step) // 2, 1)
            width = bands.width + half
            if self.width is not None or not 0 <= width <= MAX_SEARCHED_WIDTH:
                return None
            return Bands(bands.centres, width)
        centres = np.array(bands.centres)
        centres[row] += step
        is_inside = observer.START + MARGIN <= centres[row] <= observer.END - MARGIN
        if not is_inside or (np.diff(centres) < MIN_DISTANCE).any():
            return None
        return Bands(tuple(centres.tolist()), bands.width)

    def _starts(self, count: int) -> Iterator[Bands]:
        widths = START_WIDTHS if self.width is None else (self.width,)
        for low, high in RANGES:
            spacing = (high - low) / count
            centres = np.rint(low + (np.arange(count) + 0.5) * spacing)
            for width in widths:
                yield Bands(tuple(centres.tolist()), float(width))
