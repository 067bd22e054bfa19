"""What an error looks like: colours of the textures as planned, beside the best that could be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.scene.plan.evaluation import EvaluationSet

HALF, ALL = 0.5, 1.0


@dataclass(frozen=True)
class Preview:
    """The colour that ``share`` of the pixels are no worse than under a light.

    ``wanted`` and ``planned`` are ``#rrggbb``, the light's white taken to the screen's.
    """

    light: str
    share: float
    delta_e: float
    wanted: str
    planned: str


def make_previews(
    question: EvaluationSet, xyz: Sequence[Array] | Array, observer: str
) -> tuple[Preview, ...]:
    """Of the textures, for half the pixels, for the share that counts, and for all; XYZ (n, 3) under each light."""
    textures = question.groups[0]
    found = []
    screens = display_sensors([light.name for light in question.lights], observer)
    seen = zip(question.lights, screens, xyz, question.apart(xyz), strict=True)
    for light, screen, planned, apart in seen:
        order = np.argsort(apart[: len(textures.rgb)], kind="stable")
        reached = np.cumsum(textures.weights[order])
        for share in dict.fromkeys((HALF, question.share, ALL)):
            row = order[min(int(np.searchsorted(reached, share - 1e-12)), len(order) - 1)]
            pair = np.stack([light.xyz @ textures.wanted[row], planned[row]]) @ screen.xyz_to_rgb.T
            found.append(Preview(light.name, share, float(apart[row]), *hex_codes(pair)))
    return tuple(found)
