"""Criteria of painters for mixing models (Fishkin 1983, 10.4)."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from benchmarks import Row
from uplift.colorimetry import Sensor, delta_e_rgb, rgb_to_lab
from uplift.common.arrays import Array
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.paint.theories import Mixer, mixers
from uplift.lookup import Cube

SHARES = np.array([(0.75, 0.25), (0.5, 0.5), (0.25, 0.75)])
"""Proportions of shades, tints and greens."""
BLACK = np.zeros(3)
WHITE = np.ones(3)
COMPLEMENTS = (((0, 0, 1), (1, 0.5, 0)), ((1, 0, 0), (0, 1, 0)), ((1, 1, 0), (1, 0, 1)))
"""Blue and orange, red and green, yellow and purple, as saturated linear RGB."""
BLUE_YELLOW = np.array([[0.0, 0, 1], [1.0, 1, 0]])
CRITERIA = {
    "mixed with itself: no change": 0.1,  # worst ΔE00
    "with black: chromaticity kept": 0.005,  # worst Δu'v'
    "with black: darker": 0.0,  # largest change of L*
    "with white: hue kept": 3.0,  # worst turn, degrees
    "with white: lighter": 0.0,  # largest fall of L*
    "with its complement: grey": 10.0,  # worst C*ab
    "blue and yellow: green": -0.01,  # max(R, B) − G at best
}
"""Criteria of painters (Fishkin 1983, 10.4), and the largest value of each that passes,
in the order of `evaluate`.

The thesis requires tints to maintain chromaticity, too. White, however, moves every
chromaticity towards its own. A tint can only keep its hue, the direction from white in
the CIE 1976 u'v' diagram. A shade can keep both.
"""


def evaluate(mixer: Mixer, sensor: Sensor, colours: Array) -> tuple[float, ...]:
    """Measure a mixing model by every criterion, the first five with linear RGB (n, 3)
    without greys.
    """

    def chromaticities(rgb: Array) -> Array:
        """CIE 1976 u', v' (…, 2). Black, which has none, gets those of white."""
        is_lit = (rgb > 0).any(axis=-1, keepdims=True)
        return chromaticity(np.where(is_lit, sensor.xyz(rgb), sensor.light.white))

    def hues(rgb: Array) -> Array:
        u, v = np.moveaxis(chromaticities(rgb) - chromaticities(WHITE), -1, 0)
        return np.degrees(np.arctan2(v, u))

    def mix_all(pairs: Iterable[Sequence[ArrayLike]], parts: Array) -> Array:
        return np.array([mixer.mix(np.array(pair, float), parts) for pair in pairs])

    equal = np.ones(2)
    itself = mix_all(zip(colours, colours, strict=True), equal)
    shades = mix_all(((colour, BLACK) for colour in colours), 2 * SHARES)
    tints = mix_all(((colour, WHITE) for colour in colours), 2 * SHARES)
    greys = mix_all(COMPLEMENTS, equal)
    greens = mixer.mix(BLUE_YELLOW, 2 * SHARES)
    lightness = rgb_to_lab(sensor, colours)[:, None, 0]
    moves = chromaticities(shades) - chromaticities(colours)[:, None]
    turns = (hues(tints) - hues(colours)[:, None] + 180) % 360 - 180
    chroma = [np.linalg.norm(rgb_to_lab(sensor, grey)[1:]) for grey in greys]
    return (
        delta_e_rgb(sensor, colours, itself).max(),
        np.linalg.norm(moves, axis=-1).max(),
        (rgb_to_lab(sensor, shades)[..., 0] - lightness).max(),
        np.abs(turns).max(),
        (lightness - rgb_to_lab(sensor, tints)[..., 0]).max(),
        max(chroma),
        (np.maximum(greens[:, 0], greens[:, 2]) - greens[:, 1]).min(),
    )


def criteria(cube: Cube) -> Row:
    """Evaluate every mixer by every criterion on the coloured patches of an atlas."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    rows = []
    for mixer in mixers(cube):
        values = evaluate(mixer, cube.data.sensor, coloured)
        verdicts = [
            {"obeys": value <= limit, "value": value + 0.0}
            for limit, value in zip(CRITERIA.values(), values, strict=True)
        ]
        rows.append({"mixer": mixer.title, "verdicts": verdicts})
    return {"criteria_titles": list(CRITERIA), "criteria": rows}
