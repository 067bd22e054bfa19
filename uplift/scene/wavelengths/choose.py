"""So many wavelengths, or as few as a target allows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from numpy.typing import ArrayLike

from uplift.common.errors import OptionError, unknown_name
from uplift.scene.wavelengths.meyer import meyer
from uplift.scene.wavelengths.optimise import fit_at, fit_uniform, optimise
from uplift.scene.wavelengths.sampling import MEASURES, ColourErrors, Sampling, evaluate
from uplift.scene.wavelengths.setup import RenderSetup
from uplift.scene.wavelengths.uniform import prefiltered_uniform, uniform

METHODS: Mapping[str, Callable[[RenderSetup, int], Sampling]] = {
    "optimised": optimise,
    "meyer": meyer,
    "uniform": uniform,
    "bins": prefiltered_uniform,
    "fitted": fit_uniform,
}
GIVEN = "given"
"""The method where the wavelengths are given."""
MAX_COUNT = 40
"""More wavelengths than that are no saving: tables have 40 at 10 nm."""


@dataclass(frozen=True, eq=False)
class Choice:
    """What was chosen, by which method, and its errors (K, M) over the materials and lights."""

    method: str
    sampling: Sampling
    errors: ColourErrors


def choose(
    setting: RenderSetup,
    *,
    count: int | None = None,
    target: float | None = None,
    measure: str = "max",
    method: str = "optimised",
) -> Choice:
    """``count`` wavelengths, or the fewest whose ``measure`` of ΔE00 is at most ``target``.

    One set of wavelengths and of weights serves all lights of the setting, so that their radiances may be added;
    each light has its own powers, which hold what its spectrum does between the wavelengths.

    Parameters
    ----------
    measure : what the target is about: one of `MEASURES`, over all materials under all lights.
    method : one of `METHODS`.

    Raises
    ------
    OptionError : neither or both of count and target, one out of range, or a target that is out of reach.
    UnknownNameError : a method or measure that does not exist.
    """
    if method not in METHODS:
        raise unknown_name(method, METHODS, "method")
    if measure not in MEASURES:
        raise unknown_name(measure, MEASURES, "measure")
    if count is not None and target is None:
        return _fixed(setting, method, _checked(count))
    if target is not None and count is None:
        return _fewest(setting, method, target, measure)
    raise OptionError("either a count or a target says how many", hint="give one of the two")


def fit_weights(setting: RenderSetup, wavelengths: ArrayLike) -> Choice:
    """The best weights and powers for wavelengths that are given. Raises `OptionError`."""
    sampling = fit_at(setting, wavelengths).ordered()
    return Choice(GIVEN, sampling, evaluate(setting, sampling))


def _fixed(setting: RenderSetup, method: str, count: int) -> Choice:
    sampling = METHODS[method](setting, count).ordered()
    return Choice(method, sampling, evaluate(setting, sampling))


def _fewest(setting: RenderSetup, method: str, target: float, measure: str) -> Choice:
    if not target > 0:
        raise OptionError(f"target {target:g} is not above 0", hint="give a tolerated ΔE00, such as 1")
    for count in range(1, MAX_COUNT + 1):
        choice = _fixed(setting, method, count)
        reached = getattr(choice.errors, measure)
        if reached <= target:
            return choice
    raise OptionError(
        f"{MAX_COUNT} wavelengths by method '{method}' leave a {measure} of ΔE00 {reached:.3g}",
        hint=f"give a target above {target:g}, or another method",
    )


def _checked(count: int) -> int:
    if not 1 <= count <= MAX_COUNT:
        raise OptionError(f"count {count} is not within 1 to {MAX_COUNT}", hint="give a number of that range")
    return count
