"""The order of a build: atlas → fitted entries → prior → lattice and seeds → growth →
improvement → storage → cube.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.illuminants import ERROR_ILLUMINANT
from uplift.colorimetry.likely_errors import LeftOut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Indices, Mask
from uplift.common.errors import UpliftWarning, warn
from uplift.common.extensions import extension
from uplift.common.machine import single_threaded_blas
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.common.version import version
from uplift.cube.data import AtlasTable, CubeData
from uplift.fit import growth, seeds
from uplift.fit.base import learn_base
from uplift.fit.families import Family
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
    OUTWARD,
    SOLVERS,
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


def problem_of(
    options: Options, observer: str | Camera, solver: Any
) -> tuple[Options, Problem]:
    """Return the problem of a build, and options with the names of the space and of a
    camera, not aliases or files.
    """
    # r = W g, on the wavelengths of the build (docs/mathematics.md, 1)
    wavelengths = options.shortest, options.longest, options.step
    sensor = observers.sensor(options.space, options.illuminant, observer, wavelengths)
    observers.check_distinct(options.lights)
    *lights, error_light = (
        observers.light(name, sensor.observer, *sensor.range)
        for name in (*options.lights, ERROR_ILLUMINANT)
    )
    model = options.spectrum_model()
    problem = Problem(sensor, model, tuple(lights), error_light, options.threshold)
    if solver != SOLVERS[0]:
        method = extension("solver", "stock")(solver, problem.tolerance)
        problem = replace(problem, method=method)
    named: dict[str, Any] = {
        "space" if sensor.sensitivities is None else "observer": sensor.space
    }
    return replace(options, **named), problem


def _choose_lattice(
    options: Options,
    problem: Problem,
    constraints: Constraints,
    prior: Prior,
) -> Options:
    """Replace ``dim="auto"`` by the smallest lattice with room for every entry, if it
    fits into memory: one that would keep them if its nodes started from them alone.
    """
    axis, dim, lost = seeds.choose_lattice(
        problem,
        prior,
        seeds.full_entry,
        constraints.at_nodes,
        options.auto_tolerance,
    )
    if lost:
        warn(
            UpliftWarning(
                f"no dim up to {seeds.DIMS[-1]} keeps every entry within ΔE00 "
                f"{options.auto_tolerance:g}: {lost} of {len(constraints.names)} are "
                f"too close to others; dim {dim} keeps the most",
                code="no-dim-keeps-all-entries",
            )
        )
    options = replace(options, axis=axis, dim=dim)
    check_memory(options)
    return options


@dataclass(frozen=True, eq=False)
class Learnt:
    """What spectra teach, for lattices of any size."""

    constraints: Constraints
    """The fitted entries."""
    prior: Prior
    relevance: tuple[float, ...]
    """Relevance of each family."""
    left_out: LeftOut | None
    """Families, if the entries are too few to learn errors from."""


def learn(
    problem: Problem,
    entry_model: Model,
    measured: MeasuredEntries,
    families: Sequence[Family],
    known: Sequence[Family],
    trust: float | None,
) -> Learnt:
    """Fit the entries and the prior, whose trust in them is learnt if it is not given.

    The prior learns from ``families``; errors from the ``known`` ones, if the entries
    are too few.
    """
    # Entries p_i: min ‖g − m‖² + Σ |w ΔL*a*b*|² subject to r(p) = t
    # (docs/mathematics.md, 6). Prior c(x) = s(x) + d(x): smooth spectra, what families
    # deviate from them, and kriging of the entries (7).
    constraints = entries.fit_constraints(problem, entry_model, measured)
    base, relevance = learn_base(problem, families, constraints.at_nodes)
    prior = fit_prior(problem, constraints.at_nodes, base, trust)
    left_out = None
    if prior.errors is None:
        left_out = leave_out_families(problem, known, relevance)
    if left_out is not None:
        prior = replace(prior, errors=family_errors(problem, left_out))
    return Learnt(constraints, prior, relevance, left_out)


@single_threaded_blas()
def build_stages(
    atlas: AtlasLike,
    options: Options,
    problem: Problem,
    library: AtlasLike = None,
    looks: Any = None,
    scene: SceneLike | None = None,
    progress: ProgressCallback = ignore_progress,
    learn: Callable[..., Learnt] = learn,
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
    trust = 1.0 if options.trust_atlas else None
    learnt = learn(
        problem,
        entry_model,
        spectra.measured,
        spectra.families,
        spectra.known,
        trust,
    )
    constraints = learnt.constraints
    prior = learnt.prior
    if options.neutral == "flat":
        prior = prior.with_flat_greys()
    if targets is not None:
        targets, constraints, prior = targets.fit(problem, constraints, prior)

    options, seeded, boxes = _place_entries(options, problem, constraints, prior)
    kept = None
    if scene is not None:
        kept = np.flatnonzero(scene.required_points(boxes, sensor, progress))
    points, improvements = _fit_nodes(
        options, problem, constraints, prior, seeded, kept, progress
    )
    smoothed: dict[str, float] = {}
    if not options.exact_entries:
        constraints, smoothed = smooth_spots(problem, constraints, boxes, points)
        warn_of_spots(smoothed)
    table = _atlas_table(problem, constraints, prior, boxes, spectra.measured)
    outside = _outside_table(
        problem, prior, entry_model, spectra.outside, seeded.lattice
    )
    provenance = {
        "uplift": version(),
        "options": options.record(),
        **_describe_atlas(spectra),
        "prior": _describe_prior(prior),
        "smoothed": smoothed,
        **improvements,
        **({} if scene is None else {"scene": scene.describe()}),
        **_describe_library(spectra, learnt.relevance),
        **_describe_left_out(learnt.left_out),
        **({} if targets is None else targets.describe(table, problem.model, sensor)),
    }
    data = CubeData(
        model=problem.model,
        lattice=seeded.lattice,
        sensor=sensor,
        threshold=options.threshold,
        atlas=replace(table, outside=outside),
        points=points,
        error_illuminant=ERROR_ILLUMINANT,
        provenance=provenance,
        families=learnt.left_out,
    )
    return Cube(data)


def _place_entries(
    options: Options, problem: Problem, constraints: Constraints, prior: Prior
) -> tuple[Options, seeds.Seeds, EntryBoxes]:
    """Choose the lattice, the boxes of the entries in it (docs/mathematics.md, 8), and
    the nodes that start from entries: c = w c_i + (1 − w) c(x).
    """
    is_chosen = options.dim == AUTO
    if is_chosen:
        options = _choose_lattice(options, problem, constraints, prior)
    lattice = Lattice(axis_nodes(options.axis, int(options.dim)))
    rgb = constraints.at_nodes.rgb
    seeded = seeds.seed(lattice, rgb)
    boxes = EntryBoxes(lattice, rgb, seeded.half_width)
    # The choice of the lattice has counted the entries that none keeps.
    crowded = () if is_chosen else seeded.crowded
    entries.warn_of_crowded(constraints.names, crowded)
    return options, seeded, boxes


def _blend(options: Options) -> seeds.Blend:
    """Return how corners of the cells of entries start, with `seed_corners` as in the
    thesis.
    """
    if options.seed_corners or options.growth == "neighbours":
        return seeds.full_entry
    return seeds.near_entry


def _softens(options: Options, problem: Problem) -> bool:
    """Whether nodes may be moved towards their neighbours: not if they are wanted as in
    the thesis, flat, or as exact as the entries, or if codes are not for display.
    """
    if options.exact_entries or options.neutral == "flat":
        return False
    decoding = problem.sensor.decoding
    if problem.model.is_determined or np.allclose(np.diff(decoding, 2), 0):
        return False
    return _blend(options) is seeds.near_entry


def _fit_nodes(
    options: Options,
    problem: Problem,
    constraints: Constraints,
    prior: Prior,
    seeded: seeds.Seeds,
    kept: Indices | None,
    progress: ProgressCallback,
) -> tuple[PointTable, dict[str, Any]]:
    """Fit the nodes ``kept``, or all, and describe how they were improved."""
    # They grow from the seeds: min |R⁻¹ (p − p₀)|² subject to r(p) = t (5, 7), where t
    # is the nearest colour that some reflectance has (9).
    fitted = kept
    if kept is not None and _softens(options, problem):
        fitted = nodes_around(seeded.lattice, problem.sensor, seeded.rgb, kept)
    nodes = nodes_of(seeded.lattice, problem.sensor, fitted)
    steps: Sequence[str] = growth.STEPS
    multipliers = constraints.at_nodes.multipliers
    if options.growth == "neighbours":
        nodes = nodes_of(seeded.lattice, problem.sensor, None)
        steps = growth.THESIS_STEPS
        multipliers = constraints.truncated(problem.model)
    expected = partial(
        seeds.initial_guess,
        prior=prior,
        seeds=seeded,
        entries=multipliers,
        blend=_blend(options),
    )
    grow = grow_outward
    if options.growth != OUTWARD:
        grow = extension("growth", options.growth)
    grown = grow(problem, nodes, expected, seeded.points, progress)
    improvements = [
        {"step": step, "tried": tried, "mended": fixed}
        for step, tried, fixed in growth.improve(grown, steps)
    ]
    softened = 0
    if _softens(options, problem):
        softened = len(soften(grown, seeded.rgb, scene_lights(problem)))
    points = store(grown, seeded, prior)
    _warn_of_unfitted(options, points)
    if kept is not None:
        points = points.restricted_to(kept)
    done = {"improvements": improvements, "softened": softened}
    return points if options.debug else replace(points, round=None), done


def _warn_of_unfitted(options: Options, points: PointTable) -> None:
    """Warn of nodes that another solver than the default has left over the
    threshold.
    """
    unfitted = points.counts()["unfitted"]
    if unfitted and options.solver != SOLVERS[0]:
        warn(
            UpliftWarning(
                f"{pluralise(unfitted, 'node')} over the threshold with the solver "
                f"'{options.solver}'",
                code="nodes-unfitted",
                hint="use the default solver",
            )
        )


def _atlas_table(
    problem: Problem,
    constraints: Constraints,
    prior: Prior,
    boxes: EntryBoxes,
    measured: MeasuredEntries,
) -> AtlasTable:
    """Return the table of the entries in the RGB space."""
    values = _stored_spectra(prior, measured)
    table = constraints.table(problem.model, boxes.half_width, values)
    if prior.left_out is None:
        return table
    return replace(table, left_out=prior.left_out.astype(np.float32))


def _outside_table(
    problem: Problem,
    prior: Prior,
    entry_model: Model,
    outside: MeasuredEntries,
    lattice: Lattice,
) -> AtlasTable | None:
    """Return the table of the entries outside the RGB space, if there are any.

    They constrain no node: their spectra answer XYZ and textures of other spaces.
    """
    if not outside.names:
        return None
    half_width = seeds.outside_half_widths(lattice, outside.rgb)
    fitted = entries.fit_constraints(problem, entry_model, outside)
    values = _stored_spectra(prior, outside)
    return fitted.table(problem.model, half_width, values)


def _stored_spectra(
    prior: Prior, measured: MeasuredEntries
) -> NDArray[np.float32] | None:
    """Return measured reflectances if errors are learnt from them and the left-out."""
    if prior.left_out is None:
        return None
    return measured.reflectances.astype(np.float32)


def _describe_atlas(spectra: Spectra) -> dict[str, Any]:
    """Return the provenance of the entries, in JSON values."""
    return {
        "atlases": [
            {"name": source.name, "digest": source.digest, **source.changed_options()}
            for source in spectra.atlas.sources
        ],
        "left_out": list(spectra.outside.names),
        "skipped": [entry.name for entry in spectra.atlas.skipped],
    }


def _describe_prior(prior: Prior) -> dict[str, Any]:
    """Return what the kriging learnt, and the errors if the atlas is large enough."""
    learnt = {}
    if prior.kriging is not None:
        learnt = {**prior.kriging.kernel._asdict(), "trust": prior.kriging.trust}
    if prior.errors is not None:
        standard, bound = prior.errors.radii
        learnt["error_bound"] = bound / standard
    return learnt


def _describe_left_out(left_out: LeftOut | None) -> dict[str, list[str]]:
    """Return the names of the families that errors are learnt from, if they are."""
    return {} if left_out is None else {"left_out_families": list(left_out.names)}


def _describe_library(
    spectra: Spectra, relevance: Sequence[float]
) -> dict[str, list[dict[str, Any]]]:
    """Return the provenance of the learnt prior, in JSON values."""
    return {
        "libraries": [
            {"name": source.name, "digest": source.digest}
            for source, _ in spectra.libraries
        ],
        "families": [
            {"name": family.name, "relevance": weight}
            for family, weight in zip(spectra.families, relevance, strict=True)
        ],
    }
