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
from uplift.extras.scene.plan.candidates import INDEX, Candidate, Cost, SearchGrid
from uplift.extras.scene.plan.evaluation import ErrorSummary, fit_renderings
from uplift.extras.scene.plan.files import SceneFile
from uplift.extras.scene.plan.passes_advice import PassesAdvice, advise_passes
from uplift.extras.scene.plan.search import (
    explore,
    over_limits,
    pareto_front,
    sufficient,
)
from uplift.extras.scene.plan.space import (
    CEILING,
    FLOOR,
    measure_changes,
    reference_options,
    with_cubes,
    without_cubes,
)
from uplift.extras.scene.plan.trial import Builder, SceneContents, Trial
from uplift.extras.texture.scene_colours import PixelSample
from uplift.lookup.cube import Cube
from uplift.pipeline.options import Options

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
    grid = grid or SearchGrid()
    contents = SceneContents.read(scene, (grid.predicting, grid.confirming), progress)
    colours = contents.colours
    reference = reference_options(scene, grid)
    progress(Progress("reference cube", 0, 1))
    builder = Builder(contents.atlas)
    trial = Trial.of(contents, colours.predicting, builder, reference)
    tests = trial.tests
    matrices = tests.matrices()
    without_spectra = tests.error(tests.rgb @ matrices.mT)
    floor = FLOOR * scene.tolerance
    renderings = fit_renderings(grid.samples, tests, floor, progress)
    candidates = list(without_cubes(colours, renderings))
    # Cubes save nothing where RGB have no error, or colours are few.
    if colours.few is None and without_spectra.quantile > floor:
        changes = measure_changes(trial, reference, grid, floor, progress)
        candidates += with_cubes(trial, scene, colours, renderings, changes)
    promising = [each for each in candidates if each.bound <= CEILING * scene.tolerance]

    def measure(options: Options | None, group: Sequence[Candidate]) -> list[Candidate]:
        progress(Progress(group[0].name, 0, 1))
        return trial.measure(options, group, matrices)

    measured = explore(promising, measure, floor)
    finalists = sufficient(measured, scene.tolerance, scene.minimise, scene.limits)
    if not finalists:
        raise no_candidate(scene, measured)
    progress(Progress("confirmation", 0, 1))
    other = Trial.of(contents, colours.confirming, builder, reference)
    chosen, confirmed = _confirm(other, finalists, matrices, scene.tolerance)
    return Plan(
        scene=scene,
        measured=tuple(measured),
        considered=len(candidates),
        chosen=chosen,
        confirmed=confirmed,
        matrices=matrices,
        without_spectra=without_spectra,
        spectra=_list_spectra(chosen, colours.few, builder, reference),
        expected_error=_expected_error(scene, tests.reference, colours.predicting),
        passes=_advise_passes(scene, chosen, tests.setup.reflectances),
    )


def _list_spectra(
    chosen: Candidate, few: Array | None, builder: Builder, reference: Options
) -> tuple[Array, Array] | None:
    """Return colours (n, 3) and their reflectances, if the choice is a list."""
    if chosen.pixel.form != INDEX or chosen.rendering is None or few is None:
        return None
    nm = chosen.rendering.sampling.wavelengths
    return few, builder.cube(few, reference).reflectance(few, nm)


def _expected_error(
    scene: SceneFile, reference: Cube, textures: PixelSample
) -> float | None:
    """Return the mean standard error of textures under the worst light, if the cube has
    standard errors.
    """
    errors = [reference.standard_error(textures.rgb, light) for light in scene.lights]
    means = [float(error @ textures.share) for error in errors if error is not None]
    return max(means, default=None)


def _advise_passes(
    scene: SceneFile, chosen: Candidate, spectra: Array
) -> PassesAdvice | None:
    """Return the passes that an RGB renderer would need in place of the choice."""
    if chosen.rendering is None or scene.sensor().observer != DEFAULT_OBSERVER:
        return None
    return advise_passes(spectra, scene.lights, scene.tolerance, scene.quantile)


def _confirm(
    trial: Trial, finalists: Sequence[Candidate], matrices: Array, tolerance: float
) -> tuple[Candidate, ErrorSummary]:
    """The first finalist within the tolerance on other pixels, or else the one of the
    smallest error there.
    """
    tried = list[tuple[Candidate, ErrorSummary]]()
    limit = np.inf
    for finalist in finalists:
        if finalist.error.quantile > limit:
            continue
        limit = CLEARLY_SMALLER * finalist.error.quantile
        [measured] = trial.measure(finalist.cube, [finalist], matrices)
        tried.append((finalist, measured.error))
        if measured.error.quantile <= tolerance or len(tried) == FINALISTS:
            break
    # Only the last one can be within the tolerance, and then has the smallest error.
    return min(tried, key=lambda pair: pair[1].quantile)


def no_candidate(scene: SceneFile, measured: Sequence[Candidate]) -> PlanFileError:
    """The error if no candidate is within the tolerance, or within the limits as
    well.
    """
    enough = sufficient(measured, scene.tolerance, scene.minimise, {})
    if enough:
        cost = enough[0].cost
        over = over_limits(enough[0], scene.limits)[0]
        needed, allowed = (
            cost_text(costs, over) for costs in (cost, cost._replace(**scene.limits))
        )
        problem = (
            f"the cheapest within {scene.tolerance:g} needs {needed}; limits allow "
            f"{allowed}"
        )
        hint = f"raise limits.{over} or the tolerance"
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
    if key == "memory":
        return format_size(value)
    return f"{value:,.0f} {'operations' if key == 'time' else key}"
