"""Plans: components are measured, cubes that may suffice are built, the choice is
confirmed on other pixels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np

from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.common.arrays import Array
from uplift.common.errors import PlanFileError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.pages.format import format_error, format_size
from uplift.extras.scene.plan.candidates import (
    INDEX,
    Candidate,
    Cost,
    SearchGrid,
    explore,
    pareto_front,
    sufficient,
)
from uplift.extras.scene.plan.evaluation import ErrorSummary
from uplift.extras.scene.plan.files import SceneFile
from uplift.extras.scene.plan.passes_advice import PassesAdvice, advise_passes
from uplift.extras.scene.plan.space import CandidateSpace

FINALISTS = 6
"""Candidates that are confirmed, at most."""
CLEARLY_SMALLER = 0.97
"""Share of the error of a candidate that was not confirmed; the next finalist has a
smaller one.
"""


@dataclass(frozen=True, eq=False)
class Plan:
    """The Pareto front for a scene, and the choice from it, with all that it needs.

    Parameters
    ----------
    scene : SceneFile
        The scene file.
    measured : tuple of Candidate
        Candidates that were measured.
    considered : int
        Number of candidates, most of which bounds exclude.
    chosen : Candidate
        The cheapest candidate within the tolerance and the limits that was confirmed.
    confirmed : ErrorSummary
        Its error on other pixels.
    matrices : ndarray, shape (K, 3, 3)
        From linear RGB to XYZ under each light, the best without spectra.
    without_spectra : ErrorSummary
        Error of RGB with these matrices.
    spectra : tuple of ndarray, or None
        Colours (n, 3) and reflectances (n, W) of a list of spectra.
    expected_error : float or None
        Mean standard error of the textures' colours under the worst light: the ΔE00 to
        expect between a measurement of such a colour and any answer. None if the cube
        does not store standard errors.
    passes : PassesAdvice or None
        Passes of an RGB renderer that the scene needs; None if it needs no spectra, or
        has another observer than the passes.
    """

    scene: SceneFile
    measured: tuple[Candidate, ...]
    considered: int
    chosen: Candidate
    confirmed: ErrorSummary
    matrices: Array
    without_spectra: ErrorSummary
    spectra: tuple[Array, Array] | None
    expected_error: float | None
    passes: PassesAdvice | None = None

    @property
    def front(self) -> list[Candidate]:
        """Candidates that no other dominates in memory, time, samples, and error."""
        return pareto_front(self.measured)

    @property
    def within_tolerance(self) -> bool:
        """Whether the confirmed error is within the tolerance."""
        return self.confirmed.quantile <= self.scene.tolerance

    def cheapest(self, tolerance: float) -> Candidate | None:
        """Find what the scene would need with another tolerance.

        Parameters
        ----------
        tolerance : float
            ΔE00.

        Returns
        -------
        Candidate or None
            The cheapest measured candidate within it and the limits of the scene.
        """
        scene = self.scene
        enough = sufficient(self.measured, tolerance, scene.minimise, scene.limits)
        return enough[0] if enough else None


def plan(
    scene: SceneFile,
    grid: SearchGrid | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Plan:
    """Search the cheapest sufficient cube, wavelengths and texture format for a scene,
    or less.

    Parameters
    ----------
    scene : SceneFile
        The scene.
    grid : SearchGrid, optional
        Candidates to consider.
    progress : ProgressCallback, optional
        Called with each step.

    Returns
    -------
    Plan
        The Pareto front, and the choice from it.

    Raises
    ------
    PlanFileError
        If no candidate is within the tolerance, or within the limits as well
        (``no-candidate``).
    AtlasError, TextureError
        If a file cannot be read.
    """
    space = CandidateSpace(scene, grid or SearchGrid(), progress)
    measured = explore(space.candidates(), space.measure, space.floor)
    finalists = sufficient(measured, scene.tolerance, scene.minimise, scene.limits)
    if not finalists:
        raise no_candidate(scene, measured)
    chosen, confirmed = _confirm(space, finalists)
    textures = space.colours.predicting
    few = space.colours.few
    errors = (
        space.tests.reference.standard_error(textures.rgb, light)
        for light in scene.lights
    )
    spectra = None
    if chosen.pixel.form == INDEX and chosen.rendering is not None and few is not None:
        listed = space.cube(few, space.reference)
        spectra = (few, listed.reflectance(few, chosen.rendering.wavelengths))
    return Plan(
        scene=scene,
        measured=tuple(measured),
        considered=space.considered,
        chosen=chosen,
        confirmed=confirmed,
        matrices=space.matrices,
        without_spectra=space.without_spectra,
        spectra=spectra,
        expected_error=max(
            (float(error @ textures.share) for error in errors if error is not None),
            default=None,
        ),
        passes=_advise_passes(space, chosen),
    )


def _advise_passes(space: CandidateSpace, chosen: Candidate) -> PassesAdvice | None:
    """Return the passes that an RGB renderer would need in place of the choice."""
    if chosen.rendering is None or space.sensor.observer != DEFAULT_OBSERVER:
        return None
    scene = space.scene
    spectra = space.tests.setup.reflectances
    return advise_passes(spectra, scene.lights, scene.tolerance, scene.quantile)


def _confirm(
    space: CandidateSpace, finalists: Sequence[Candidate]
) -> tuple[Candidate, ErrorSummary]:
    """The first finalist within the tolerance on other pixels, or else the one of the
    smallest error there.
    """
    space.progress(Progress("confirmation", 0, 1))
    tests = space.evaluation_set(space.colours.confirming)
    tried = list[tuple[Candidate, ErrorSummary]]()
    limit = np.inf
    for finalist in finalists:
        if finalist.error.quantile > limit:
            continue
        limit = CLEARLY_SMALLER * finalist.error.quantile
        options = finalist.cube
        cube = space.cube(tests.rgb, options) if options else tests.reference
        (measured,) = space.errors(cube, [finalist], tests)
        tried.append((finalist, measured.error))
        if measured.error.quantile <= space.scene.tolerance or len(tried) == FINALISTS:
            break
    # Only the last one can be within the tolerance, and then has the smallest error.
    return min(tried, key=lambda pair: pair[1].quantile)


def no_candidate(scene: SceneFile, measured: Sequence[Candidate]) -> PlanFileError:
    """The error if no candidate is within the tolerance, or within the
    limits as well.
    """
    enough = sufficient(measured, scene.tolerance, scene.minimise, {})
    if enough:
        cost = enough[0].cost
        allowance = cost._replace(**scene.limits)
        over = [
            key for key, limit in scene.limits.items() if getattr(cost, key) > limit
        ]
        needs = " and ".join(cost_text(cost, key) for key in over)
        allowed = " and ".join(cost_text(allowance, key) for key in over)
        problem = (
            f"the cheapest within {scene.tolerance:g} needs {needs}; limits allow "
            f"{allowed}"
        )
        hint = f"raise limits.{over[0]} or the tolerance"
    else:
        best = min(measured, key=attrgetter("error.quantile")).error.worst
        problem = (
            f"the smallest error is ΔE00 {format_error(best.quantile)}, of "
            f"{best.group} under {best.light}; tolerance allows {scene.tolerance:g}"
        )
        hint = f"set tolerance = {np.ceil(best.quantile * 110) / 100:g} or more"
    return PlanFileError(
        f"no candidate: {problem}", code="no-candidate", path=scene.path, hint=hint
    )


def cost_text(cost: Cost, key: str) -> str:
    """A cost with its unit."""
    value = getattr(cost, key)
    return (
        format_size(value)
        if key == "memory"
        else f"{value:,.0f} {'operations' if key == 'time' else key}"
    )
