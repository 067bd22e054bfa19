"""Methods by name, and the fewest wavelengths that meet a target."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import pluralise
from uplift.extras.papers.wavelengths import meyer, optimise
from uplift.extras.papers.wavelengths import sampling as setups
from uplift.extras.papers.wavelengths.sampling import RenderSetup, Sampling

METHODS: Mapping[str, Callable[[RenderSetup, int], Sampling]] = {
    "optimised": optimise.optimise,
    "meyer": meyer.meyer,
    "uniform": setups.uniform,
    "bins": lambda setup, count: setups.prefiltered(setup, setups.midpoints(count)),
    "fitted": lambda setup, count: optimise.fit_at(setup, setups.midpoints(count)),
}
"""Methods by name: all fitted, Meyer 1988, and three with even spacing."""
MAX_COUNT = 40
"""Largest number of wavelengths: as many as tables at 10 nm have."""


@dataclass(frozen=True, eq=False)
class Choice:
    """Chosen wavelengths and their errors.

    Parameters
    ----------
    method : str
        A key of `METHODS`, or ``"given"``.
    sampling : Sampling
        Wavelengths, weights and powers.
    errors : ndarray, shape (K, M)
        ΔE00 of the M materials under the K lights.
    """

    method: str
    sampling: Sampling
    errors: Array


def choose(
    setup: RenderSetup,
    *,
    count: int | None = None,
    target: float | None = None,
    method: str = "optimised",
) -> Choice:
    """Choose ``count`` wavelengths, or the fewest that meet a target.

    One set of wavelengths and weights serves all lights, so that their radiances may be
    added. The powers differ by light: they account for the spectrum of the light
    between the wavelengths.

    Parameters
    ----------
    setup : RenderSetup
        Materials and lights.
    count : int, optional
        Number of wavelengths, 1 to `MAX_COUNT`. Exactly one of ``count`` and ``target``
        is required.
    target : float, optional
        Largest accepted ΔE00 of any material under any light, above 0.
    method : {"optimised", "meyer", "uniform", "bins", "fitted"}, optional
        One of `METHODS`.

    Returns
    -------
    Choice
        Wavelengths with weights, powers and errors.

    Raises
    ------
    OptionError
        Both or neither of ``count`` and ``target``, a value out of range, a count
        without a rule of the method (``undefined-rule``), or a target that no count
        meets.
    UnknownNameError
        The method does not exist.
    """
    _check_choice(count, target, method)
    for number in range(1, MAX_COUNT + 1) if count is None else (count,):
        try:
            choice = _judged(method, setup, METHODS[method](setup, number))
        except OptionError as problem:
            if count is not None or problem.code != "undefined-rule":
                raise
            continue
        error = float(choice.errors.max())
        if target is None or error <= target:
            return choice
    missed = (
        f"no count up to {MAX_COUNT} meets a largest ΔE00 of {target:g} by method "
        f"'{method}'"
    )
    reached = f"{pluralise(len(choice.sampling), 'wavelength')} reach {error:.3g}"
    raise OptionError(
        f"{missed}; {reached}", hint="raise the target or choose another method"
    )


def _check_choice(count: int | None, target: float | None, method: str) -> None:
    """Check the arguments of `choose`."""
    if method not in METHODS:
        raise unknown_name(method, METHODS, "method")
    if (count is None) == (target is None):
        raise OptionError(
            "exactly one of count and target is required", hint="give one of them"
        )
    if count is not None and not 1 <= count <= MAX_COUNT:
        raise OptionError(
            f"count must be in [1, {MAX_COUNT}], got {count}",
            hint="tables at 10 nm have 40",
        )
    if target is not None and not target > 0:
        raise OptionError(
            f"target must be positive, got {target:g}",
            hint="give a tolerated ΔE00, such as 1",
        )


def fit_weights(setup: RenderSetup, wavelengths: ArrayLike) -> Choice:
    """Fit the weights and powers for given wavelengths.

    Parameters
    ----------
    setup : RenderSetup
        Materials and lights.
    wavelengths : array_like, shape (n,)
        Distinct wavelengths in nm within the grid of the setup.

    Returns
    -------
    Choice
        The wavelengths in ascending order, with weights, powers and errors.

    Raises
    ------
    OptionError
        No wavelengths, one that lies outside the grid, or one given twice.
    """
    return _judged("given", setup, optimise.fit_at(setup, wavelengths))


def choose_orders(
    setup: RenderSetup, orders: tuple[int, int, int], channels: str = "opponent"
) -> Choice:
    """Apply Meyer's quadrature with a given order for each channel.

    Meyer 1988, section 4.1: tables 1a and 1b have the rules of the opponent channels,
    figure 6 compares the spaces.

    Parameters
    ----------
    setup : RenderSetup
        Materials and lights.
    orders : tuple of int
        Number of wavelengths, 1 to 10, of each channel: A, C1, C2; S, M, L; or X, Y, Z.
    channels : {"opponent", "cones", "xyz"}, optional
        Channels whose sensitivities are the weight functions.

    Returns
    -------
    Choice
        The wavelengths of all channels, with weights, powers and errors.

    Raises
    ------
    OptionError
        An order is out of range, or its quadrature is undefined.
    UnknownNameError
        The channels do not exist.
    """
    if channels not in meyer.SPACES:
        raise unknown_name(channels, meyer.SPACES, "channels")
    space = meyer.SPACES[channels](setup.wavelengths, setup.cmfs)
    return _judged("meyer", setup, meyer.meyer_orders(setup, orders, space))


def _judged(method: str, setup: RenderSetup, sampling: Sampling) -> Choice:
    sampling = setups.ordered(sampling)
    return Choice(method, sampling, setups.evaluate(setup, sampling))
