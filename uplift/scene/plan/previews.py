"""Previews of an error: colours of the textures by the plan next to those of the reference cube."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.scene.plan.evaluation import EvaluationSet

MEDIAN, ALL = 0.5, 1.0


@dataclass(frozen=True)
class Preview:
    """A colour of the textures under a light.

    Parameters
    ----------
    light : str
        Name of the light.
    share : float
        Share of the pixels whose error is at most that of this colour.
    delta_e : float
        Its ΔE00.
    reference, planned : str
        The colour by the reference cube and by the plan, ``#rrggbb``, with the light's white as that of the display.
    """

    light: str
    share: float
    delta_e: float
    reference: str
    planned: str


def make_previews(tests: EvaluationSet, xyz: Sequence[Array] | Array, observer: str) -> tuple[Preview, ...]:
    """Previews for half of the pixels, for the quantile of the scene, and for all; XYZ (n, 3) under each light."""
    textures = tests.groups[0]
    displays = display_sensors([light.name for light in tests.lights], observer)
    previews = []
    for light, display, planned, delta_e in zip(tests.lights, displays, xyz, tests.delta_e(xyz), strict=True):
        order = np.argsort(delta_e[: len(textures.rgb)], kind="stable")
        cumulative = np.cumsum(textures.weights[order])
        for share in dict.fromkeys((MEDIAN, tests.quantile, ALL)):
            row = order[min(int(np.searchsorted(cumulative, share - 1e-12)), len(order) - 1)]
            pair = np.stack([light.xyz @ textures.reflectances[row], planned[row]]) @ display.xyz_to_rgb.T
            previews.append(Preview(light.name, share, float(delta_e[row]), *hex_codes(pair)))
    return tuple(previews)
