"""The order of a build: atlas → fitted entries → prior → lattice and seeds → growth →
improvement → storage → cube.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np

from uplift.colorimetry import observer as observers
from uplift.colorimetry.illuminants import ERROR_ILLUMINANT
from uplift.colorimetry.likely_errors import LeftOut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import UpliftWarning, warn
from uplift.common.extensions import extension
from uplift.common.machine import single_threaded_blas
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.common.version import version
from uplift.cube.data import AtlasTable, CubeData
from uplift.fit import growth, seeds
from uplift.fit.base import learn_base
from uplift.fit.gradients import nodes_around, soften
from uplift.fit.growth_outward import grow_outward
from uplift.fit.left_out_families import family_errors, leave_out_families
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.store import store
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lattice.point_table import PointTable
from uplift.lookup.cube import Cube
from uplift.models.model import Model
from uplift.pipeline import entries
from uplift.pipeline.entries import AtlasLike, Constraints, MeasuredEntries, Spectra
from uplift.pipeline.options import (
    AUTO,
    LEAST_CHANGE,
    OUTWARD,
    Options,
    check_memory,
)
from uplift.pipeline.spots import scene_lights, smooth_spots, warn_of_spots


class SceneLike(Protocol):
    """Colours that restrict a build to the nodes that they require."""

    def required_points(
        self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback
    ) -> Mask:
        """Return the mask (dim³,) of the required nodes, and report events of stage
        ``"images"``.
        """
        ...

    def describe(self) -> list[dict[str, Any]]:
        """Describe the sources of the colours for the provenance of the cube, in
        JSON values.
        """
        ...


def problem_of(options: Options) -> tuple[Options, Problem]:
    """Return the problem of a build, and options with the names of the space and of a
    camera, not aliases or files.
    """
    # r = W g, on the wavelengths of the build (docs/mathematics.md, 1)
    wavelengths = options.shortest, options.longest, options.step
    sensor = observers.sensor(
        options.space, options.illuminant, options.observer, wavelengths
    )
    observers.check_distinct(options.lights)
    *lights, error_light = (
        observers.light(name, sensor.observer, *sensor.range)
        for name in (*options.lights, ERROR_ILLUMINANT)
    )
    model = options.spectrum_model()
    problem = Problem(sensor, model, tuple(lights), error_light, options.threshold)
    if options.solver != LEAST_CHANGE:
        method = extension("solver", "stock")(options.solver, problem.tolerance)
        problem = replace(problem, method=method)
    if sensor.sensitivities is None:
        return replace(options, space=sensor.space), problem
    return replace(options, observer=sensor.space), problem


@dataclass(frozen=True, eq=False)
class Learnt:
    """What spectra teach, for lattices of any size."""

    constraints: Constraints
    """The fitted entries."""
    prior: Prior
    relevance: tuple[float, ...]
    """Relevance of each family that the prior learns from."""
    left_out: LeftOut | None
    """Families, if the entries are too few to learn errors from."""

    def describe(self, spectra: Spectra) -> dict[str, Any]:
        """Return the provenance of the prior, in JSON values."""
        prior: dict[str, Any] = {}
        if self.prior.kriging is not None:
            kriging = self.prior.kriging
            prior = {**kriging.kernel._asdict(), "trust": kriging.trust}
        if self.prior.errors is not None:
            standard, bound = self.prior.errors.radii
            prior["error_bound"] = bound / standard
        families = [
            {"name": family.name, "relevance": weight}
            for family, weight in zip(spectra.families, self.relevance, strict=False)
        ]
        described = {"prior": prior, "families": families}
        if self.left_out is not None:
            described["left_out_families"] = list(self.left_out.names)
        return described


def learn(
    problem: Problem, entry_model: Model, spectra: Spectra, options: Options
) -> Learnt:
    """Fit the entries and the prior. Errors are learnt from the families if the entries
    are too few.
    """
    # Entries p_i: min ‖g − m‖² + Σ |w ΔL*a*b*|² subject to r(p) = t
    # (docs/mathematics.md, 6). Prior c(x) = s(x) + d(x): smooth spectra, what families
    # deviate from them, and kriging of the entries (7).
    constraints = entries.fit_constraints(problem, entry_model, spectra.measured)
    families = spectra.families if options.learns_families else ()
    base, relevance = learn_base(problem, families, constraints.at_nodes)
    trust = 1.0 if options.trust_atlas else None
    prior = fit_prior(problem, constraints.at_nodes, base, trust)
    left_out = None
    if prior.errors is None:
        left_out = leave_out_families(problem, spectra.families, relevance)
    if left_out is not None:
        prior = replace(prior, errors=family_errors(problem, left_out))
    return Learnt(constraints, prior, relevance, left_out)


@single_threaded_blas()
def build_stages(
    atlas: AtlasLike,
    options: Options,
    problem: Problem,
    *,
    library: AtlasLike = None,
    looks: Any = None,
    scene: SceneLike | None = None,
    progress: ProgressCallback = ignore_progress,
    learn: Callable[[Problem, Model, Spectra, Options], Learnt] = learn,
) -> Cube:
    """Build a cube from checked options and the problem that they describe; builds may
    share what they ``learn``.
    """
    sensor = problem.sensor
    entry_model = options.spectrum_model(options.entry_coefficients)
    spectra = entries.read_spectra(atlas, library, options, sensor)
    targets = None
    if looks is not None:  # they become further entries
        targets_of = extension("looks", "targets")
        names = spectra.atlas.names
        targets = targets_of(looks, entry_model, sensor, names, spectra.measured)
    learnt = learn(problem, entry_model, spectra, options)
    if options.neutral == "flat":
        learnt = replace(learnt, prior=learnt.prior.with_flat_greys())
    if targets is not None:
        targets, constraints, prior = targets.fit(
            problem, learnt.constraints, learnt.prior
        )
        learnt = replace(learnt, constraints=constraints, prior=prior)
    constraints = learnt.constraints
    prior = learnt.prior

    options, seeded = _place_entries(options, problem, constraints, prior)
    boxes = EntryBoxes(seeded.lattice, seeded.rgb, seeded.half_width)
    kept = None
    if scene is not None:
        kept = np.flatnonzero(scene.required_points(boxes, sensor, progress))
    points, improvements = _fit_nodes(
        options, problem, learnt, seeded, kept, progress=progress
    )
    smoothed: dict[str, float] = {}
    if not options.exact_entries:
        constraints, smoothed = smooth_spots(problem, constraints, boxes, points)
        warn_of_spots(smoothed)
    tabulate = partial(_atlas_table, problem, prior)
    table = tabulate(constraints, boxes.half_width, spectra.measured)
    if prior.left_out is not None:
        table = replace(table, left_out=prior.left_out.astype(np.float32))
    if spectra.outside.names:
        # They constrain no node: their spectra answer XYZ and textures of other spaces.
        widths = seeds.outside_half_widths(seeded.lattice, spectra.outside.rgb)
        fitted = entries.fit_constraints(problem, entry_model, spectra.outside)
        table = replace(table, outside=tabulate(fitted, widths, spectra.outside))
    provenance = {
        "uplift": version(),
        "options": options.record(),
        **spectra.describe(),
        **learnt.describe(spectra),
        "smoothed": smoothed,
        **improvements,
        **({} if scene is None else {"scene": scene.describe()}),
        **({} if targets is None else targets.describe(table, problem.model, sensor)),
    }
    data = CubeData(
        model=problem.model,
        lattice=seeded.lattice,
        sensor=sensor,
        threshold=options.threshold,
        atlas=table,
        points=points,
        error_illuminant=ERROR_ILLUMINANT,
        provenance=provenance,
        families=learnt.left_out,
    )
    return Cube(data)


def _place_entries(
    options: Options, problem: Problem, constraints: Constraints, prior: Prior
) -> tuple[Options, seeds.Seeds]:
    """Choose the lattice, the boxes of the entries in it (docs/mathematics.md, 8), and
    the nodes that start from entries: c = w c_i + (1 − w) c(x).

    ``dim="auto"`` is replaced by the smallest lattice with room for every entry, if it
    fits into memory: one that would keep them if its nodes started from them alone.
    """
    at_nodes = constraints.at_nodes
    is_chosen = options.dim == AUTO
    if is_chosen:
        tolerance = options.auto_tolerance
        axis, dim, lost = seeds.choose_lattice(problem, prior, at_nodes, tolerance)
        if lost:
            text = (
                f"no dim up to {seeds.DIMS[-1]} keeps every entry within ΔE00 "
                f"{tolerance:g}: {lost} of {len(constraints.names)} are too close to "
                f"others; dim {dim} keeps the most"
            )
            warn(UpliftWarning(text, code="no-dim-keeps-all-entries"))
        options = replace(options, axis=axis, dim=dim)
        check_memory(options)
    lattice = Lattice(axis_nodes(options.axis, int(options.dim)))
    seeded = seeds.seed(lattice, at_nodes.rgb)
    if not is_chosen:  # the choice of the lattice has counted those that none keeps
        entries.warn_of_crowded(constraints.names, seeded.crowded)
    return options, seeded


def _starts_as_thesis(options: Options) -> bool:
    """Whether corners of the cells of entries start from the entries."""
    return options.seed_corners or options.growth == "neighbours"


def _softens(options: Options, problem: Problem) -> bool:
    """Whether nodes may be moved towards their neighbours: not if they are wanted as in
    the thesis, flat, or as exact as the entries, or if codes are not for display.
    """
    decoding = problem.sensor.decoding
    is_linear = np.allclose(np.diff(decoding, 2), 0)
    return not (
        options.exact_entries
        or options.neutral == "flat"
        or problem.model.is_determined
        or is_linear
        or _starts_as_thesis(options)
    )


def _fit_nodes(
    options: Options,
    problem: Problem,
    learnt: Learnt,
    seeded: seeds.Seeds,
    kept: Indices | None,
    progress: ProgressCallback,
) -> tuple[PointTable, dict[str, Any]]:
    """Fit the nodes ``kept``, or all, and describe how they were improved."""
    # They grow from the seeds: min |R⁻¹ (p − p₀)|² subject to r(p) = t (5, 7), where t
    # is the nearest colour that some reflectance has (9).
    softens = _softens(options, problem)
    is_thesis = options.growth == "neighbours"
    fitted = kept
    if kept is not None and softens:
        fitted = nodes_around(seeded.lattice, problem.sensor, seeded.rgb, kept)
    nodes = nodes_of(seeded.lattice, problem.sensor, None if is_thesis else fitted)
    multipliers = learnt.constraints.at_nodes.multipliers
    if is_thesis:
        multipliers = learnt.constraints.truncated(problem.model)
    blend = seeds.full_entry if _starts_as_thesis(options) else seeds.near_entry
    expected = partial(
        seeds.initial_guess,
        prior=learnt.prior,
        seeds=seeded,
        entries=multipliers,
        blend=blend,
    )
    grow = grow_outward
    if options.growth != OUTWARD:
        grow = extension("growth", options.growth)
    grown = grow(problem, nodes, expected, seeded.points, progress)
    steps = growth.THESIS_STEPS if is_thesis else growth.STEPS
    improvements = [
        {"step": step, "tried": tried, "mended": fixed}
        for step, tried, fixed in growth.improve(grown, steps)
    ]
    softened = 0
    if softens:
        softened = len(soften(grown, seeded.rgb, scene_lights(problem)))
    points = store(grown, seeded, learnt.prior)
    unfitted = points.counts()["unfitted"]
    if unfitted and options.solver != LEAST_CHANGE:
        solver = options.record()["solver"]
        text = f"{pluralise(unfitted, 'node')} over the threshold with the solver"
        hint = "use the default solver"
        warn(UpliftWarning(f"{text} '{solver}'", code="nodes-unfitted", hint=hint))
    if kept is not None:
        points = points.restricted_to(kept)
    if not options.debug:
        points = replace(points, round=None)
    return points, {"improvements": improvements, "softened": softened}


def _atlas_table(
    problem: Problem,
    prior: Prior,
    constraints: Constraints,
    half_width: Array,
    measured: MeasuredEntries,
) -> AtlasTable:
    """Return the table of entries, with measured reflectances if errors are learnt from
    them and the left-out.
    """
    values = None
    if prior.left_out is not None:
        values = measured.reflectances.astype(np.float32)
    return constraints.table(problem.model, half_width, values)
