"""Which further light to photograph a scene under: candidates by the errors that are
expected to remain.

With a photograph under each candidate, the left-out materials of a cube are answered
again, with noise. The standard errors that follow (docs/mathematics.md, 10) are
averaged over the colours of images and over the target lights of relighting.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import Photograph, photograph
from uplift.extras.texture.scene_colours import PixelSample
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import LightErrors
from uplift.lookup.errors_under_lights import light_errors as errors_of_cube

CANDIDATES = tuple(DESCRIPTIONS)
"""Lights that are compared by default, but for that of the cube."""
NOISE = (0.005, 0.0005)
"""Noise of photographs by default: a share of each value, and a floor."""


@dataclass(frozen=True)
class RemainingError:
    """Mean standard error of the colours of a scene with a photograph under a further
    ``light``, by target light. The light is None without such a photograph.
    """

    light: str | None
    by_light: Mapping[str, float]

    @property
    def mean(self) -> float:
        """Mean over the lights."""
        return float(np.mean(list(self.by_light.values())))


def rank_second_lights(
    cube: Cube,
    colours: PixelSample,
    candidates: Sequence[Illuminant],
    targets: Sequence[Light],
    noise: tuple[float, float] = NOISE,
) -> list[RemainingError]:
    """Rank lights for a further photograph by the error that is expected to remain.

    Parameters
    ----------
    cube : Cube
        A cube with left-out materials, which answers the first photograph.
    colours : PixelSample
        Colours of the scene, linear RGB of the cube, and their areas.
    candidates : sequence of str or Lamp
        Lights of a further photograph.
    targets : sequence of Light
        Lights under which errors are averaged.
    noise : tuple of float
        Standard deviation of linear RGB in the photographs: a share of each value, and
        a floor.

    Returns
    -------
    list of RemainingError
        One for each candidate, the least mean first.

    Raises
    ------
    OptionError
        No candidate, or no target light; a candidate is the light of
        the cube; a cube without left-out materials; noise that is negative.
    UnknownNameError
        A light is unknown.
    """
    if not candidates or not targets:
        raise OptionError("give at least one candidate, and one target light")
    sensor = cube.data.sensor
    photographs = [photograph(sensor, light) for light in candidates]
    remaining = [
        _with_photograph(cube, colours, further, targets, noise)
        for further in photographs
    ]
    return sorted(remaining, key=lambda candidate: candidate.mean)


def error_without(
    cube: Cube, colours: PixelSample, targets: Sequence[Light]
) -> RemainingError:
    """Return the mean standard error of the colours of a scene with one photograph.
    `OptionError` for a cube without left-out materials.
    """
    estimates = [errors_of_cube(cube.data, light) for light in targets]
    return RemainingError(None, _means(estimates, colours, targets))


def default_candidates(cube: Cube) -> tuple[str, ...]:
    """Return `CANDIDATES` without the light of a cube."""
    known = cube.data.sensor.illuminant
    return tuple(name for name in CANDIDATES if name != known)


def _with_photograph(
    cube: Cube,
    colours: PixelSample,
    further: Photograph,
    targets: Sequence[Light],
    noise: tuple[float, float],
) -> RemainingError:
    photographs = prepare(cube, [further], noise)
    estimates = [light_errors(photographs, light) for light in targets]
    return RemainingError(further.light, _means(estimates, colours, targets))


def _means(
    estimates: Sequence[LightErrors], colours: PixelSample, targets: Sequence[Light]
) -> dict[str, float]:
    """Mean standard errors over the areas of colours, by light."""
    means = {}
    for light, estimate in zip(targets, estimates, strict=True):
        standard: Array = estimate(colours.rgb)[:, 0]
        means[light.name] = float(standard @ colours.share)
    return means
