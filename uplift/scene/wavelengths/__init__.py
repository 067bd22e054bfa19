"""As few wavelengths as a scene needs: `choose` for a `Setting` of materials and lights; `weigh` for given ones.

from uplift.scene import wavelengths

seen = wavelengths.set_up(reflectances, ["D65", "FL11"])
choice = wavelengths.choose(seen, target=1.0)
choice.sampling.wavelengths, choice.sampling.to_xyz, choice.sampling.powers, choice.errors.max
"""

from __future__ import annotations

from uplift.scene.wavelengths.choose import METHODS, MOST, Choice, choose, weigh
from uplift.scene.wavelengths.sampling import MEASURES, Errors, Sampling, judge
from uplift.scene.wavelengths.setup import Setting, grid, set_up

__all__ = [
    "MEASURES",
    "METHODS",
    "MOST",
    "Choice",
    "Errors",
    "Sampling",
    "Setting",
    "choose",
    "grid",
    "judge",
    "set_up",
    "weigh",
]
