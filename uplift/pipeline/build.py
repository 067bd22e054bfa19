"""The order of a build: atlas → fitted entries → prior → lattice and seeds → growth →
improvement → storage → cube.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from uplift.atlas import Atlas, Source
from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.lights import (
    DEFAULT_ILLUMINANT,
    ERROR_ILLUMINANT,
    SCENE_LIGHTS,
    Illuminant,
)
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Mask, StrPath
from uplift.common.errors import UpliftWarning, warn
from uplift.common.extensions import extension
from uplift.common.machine import single_threaded_blas
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.common.version import version
from uplift.cube import AtlasTable, CubeData
from uplift.fit import growth, seeds
from uplift.fit.base import learn_base
from uplift.fit.families import Family
from uplift.fit.growth_outward import grow_outward
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.store import store
from uplift.lattice import EntryBoxes, Lattice, PointTable, axis_nodes
from uplift.lookup import Cube
from uplift.models.model import Model
from uplift.models.moments import MAX_COUNT
from uplift.pipeline import entries
from uplift.pipeline.entries import AtlasLike, Constraints, MeasuredEntries
from uplift.pipeline.options import (
    AUTO,
    CUSTOM,
    OUTWARD,
    SOLVERS,
    GrowthName,
    ModelName,
    NeutralName,
    Options,
    PriorName,
    check_memory,
)

if TYPE_CHECKING:

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


def build(
    atlas: AtlasLike = None,
    *,
    dim: int | Literal["auto"] = 32,
    model: ModelName = "moments",
    coefficients: int = 9,
    entry_coefficients: int = MAX_COUNT,
    warp: Literal["none", "vision", "colour"] = "none",
    axis: Literal["srgb", "linear"] = "srgb",
    space: str = "sRGB",
    illuminant: str = DEFAULT_ILLUMINANT,
    observer: str | Camera = observers.DEFAULT_OBSERVER,
    shortest: float = observers.START,
    longest: float = observers.END,
    step: float = observers.STEP,
    lights: Sequence[Illuminant] = SCENE_LIGHTS,
    prior: PriorName = "learnt",
    neutral: NeutralName = "expected",
    library: AtlasLike = None,
    looks: Any = None,
    leave_out: Sequence[str] = (),
    threshold: float = 1e-4,
    auto_tolerance: float = 0.5,
    seed_corners: bool = False,
    growth: GrowthName = "outward",
    solver: Any = "least-change",
    debug: bool = False,
    scene: SceneLike | StrPath | Sequence[StrPath] | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Cube:
    """Build a spectral uplifting cube, constrained by measured spectra if an atlas is
    given.

    Parameters
    ----------
    atlas : Atlas, path-like or sequence of path-like, optional
        Measured spectra, or the files that contain them.
    dim : int or {"auto"}, default 32
        Nodes along each axis, at least 2. ``"auto"`` chooses the smallest lattice, and
        its axis, that keeps every atlas entry within ``auto_tolerance``.
    model : {"moments", "sigmoid"}, default "moments"
        Spectrum model: bounded trigonometric moments, or the sigmoid of a quadratic.
    coefficients : int, default 9
        Coefficients per spectrum of the moment model, 3 to 17: the number of moments
        plus one. The sigmoid has 3.
    entry_coefficients : int, default 17
        Coefficients of the spectra of atlas entries in the moment model, from
        ``coefficients`` to 17. Entries are few, so more of them cost little, and the
        answers at and near the colours of entries come closer to the measurements.
    warp : {"none", "vision", "colour"}, default "none"
        Map from wavelengths to the phase of the moments. ``"vision"`` resolves
        wavelengths by the sensitivity of the eye.
    axis : {"srgb", "linear"}, default "srgb"
        Spacing of the axis nodes: equal steps of the sRGB encoding, or of linear RGB.
    space : str, default "sRGB"
        RGB space of queries, by its name in colour-science, or ``"camera"``: raw values
        of a camera, balanced so that a perfect white under the illuminant is (1, 1, 1).
    illuminant : str, default "D65"
        Illuminant under which reflectances have their RGB.
    observer : str or Camera, default "CIE 1931 2 Degree Standard Observer"
        Colour-matching functions, by their name in colour-science. With
        ``space="camera"`` a camera: its name in colour-science, a CSV file of its
        sensitivities, or a `Camera`.
    shortest, longest : float, default 380 and 780
        Range of the spectra in nm, at most 300 to 1000. Outside the range of an entry,
        its spectrum continues as a constant, and so does the learnt prior outside 380
        to 780; outside the range of the cube, every spectrum does. The coefficients are
        shared by the whole range, so a much wider one resolves less (docs/accuracy.md).
    step : {1, 5, 10}, default 5
        Distance in nm of the wavelengths at which spectra are integrated and compared.
    lights : sequence of str or Lamp, default ("D65", "A", "FL2", "FL11", "LED-B3")
        Illuminants under which fitted atlas entries must keep their measured colours.
    prior : {"learnt", "smooth"}, default "learnt"
        Spectra of colours that no entry constrains: those expected of real materials,
        or smooth ones.
    neutral : {"expected", "flat"}, default "expected"
        Spectra of colours with equal components: as of all other colours, or flat,
        fading to those expected of real materials from a CIE L*a*b* chroma of 4 to 12.
        Entries keep their measured spectra.
    library : Atlas, path-like or sequence of path-like, optional
        Measured spectra that shape the learnt prior but are not constraints. Each file
        is a family of materials like those to be expected; with an atlas, its weight is
        learnt.
    looks : Look, path-like or sequence of Look, optional
        Colours and what they are to be under other lights, or a TOML file of them; see
        `uplift.Look`. Each is an entry of the cube like a measured one. Colours near it
        follow.
    leave_out : sequence of str, optional
        Families of the shipped library that the learnt prior must not know, for tests
        on them.
    threshold : float, default 1e-4
        Largest ``|target − stored|`` of a fitted node in linear RGB, in (0, 0.1].
    auto_tolerance : float, default 0.5
        With ``dim="auto"``: largest ΔE00, under ``lights``, between an entry and the
        lattice.
    seed_corners : bool, default False
        Start all eight corners of the cell of each atlas entry from the entry, as
        Tódová 2020 does. By default, seven of them start half-way between entry and
        prior, and at colours unlike the entry's nearer to the prior.
        ``growth="neighbours"`` always does.
    growth : {"outward", "coarse-to-fine", "neighbours"}, default "outward"
        Order in which nodes are fitted: outward from the atlas entries, in shells, or
        from a coarse lattice to finer ones. Both start from the spectrum that the atlas
        lets expect at a colour, and have the same answers. ``"neighbours"`` goes
        outward and starts from the spectra of fitted neighbours (Tódová 2020, section
        3.1).
    solver : str or optimistix.AbstractLeastSquaresSolver, default "least-change"
        Solver of nodes, all of optimistix: ``"least-change"``, our own, ``"dogleg"``,
        ``"levenberg-marquardt"``, ``"gauss-newton"``, or any least-squares solver or
        minimiser. The default is fastest; answers agree except for nearly box-shaped
        spectra (docs/accuracy.md).
    debug : bool, default False
        Store the round of growth in which each node was fitted.
    scene : SceneLike, path-like or sequence of path-like, optional
        Images, or another set of colours. Only the nodes that answer these colours are
        fitted.
    progress : callable, optional
        Called with `Progress` events of the stages ``"images"``, ``"fit"`` and
        ``"store"``.

    Returns
    -------
    Cube
        The cube, ready for queries; `Cube.save` writes it.

    Raises
    ------
    AtlasError
        An atlas file that cannot be read, or an atlas without an entry in the RGB space
        (``atlas-out-of-gamut``).
    OptionError
        An option outside its range, or a library without a learnt prior.
    LookError
        A look that cannot be read, has the colour or the name of an entry or of another
        look, or needs a model with more coefficients.
    UnknownNameError
        An unknown space, illuminant, observer, model, axis, prior, family, growth or
        solver.

    Warns
    -----
    UpliftWarning
        Entries with the colour of another entry (``entry-duplicate``) or close to
        another entry (``entry-crowded``). Spectra of a library out of gamut
        (``entry-out-of-gamut``) or outside [0, 1] (``entry-clipped``). Looks that no
        reflectance meets (``look-impossible``), or that the coefficients of entries do
        not reach (``look-not-reached``); the nearest colour is used. Entries out of
        gamut give no warning: `Cube.outside_names` has them.

    Examples
    --------
    >>> import uplift
    >>> cube = uplift.build(dim=3, coefficients=5)
    >>> cube.reflectance([1.0, 1.0, 1.0], [450, 550, 650]).round(3).tolist()
    [1.0, 1.0, 1.0]
    """
    options = Options(
        dim=dim,
        model=model,
        coefficients=coefficients,
        entry_coefficients=entry_coefficients,
        warp=warp,
        axis=axis,
        space=space,
        illuminant=illuminant,
        observer=observer.name if isinstance(observer, Camera) else observer,
        shortest=shortest,
        longest=longest,
        step=step,
        lights=lights,  # type: ignore[arg-type]  # becomes a tuple
        prior=prior,
        neutral=neutral,
        leave_out=leave_out,  # type: ignore[arg-type]
        threshold=threshold,
        auto_tolerance=auto_tolerance,
        seed_corners=seed_corners,
        growth=growth,
        solver=solver if isinstance(solver, str) else CUSTOM,
        debug=debug,
    )
    colours = _as_scene(scene)
    check_memory(options)
    options, problem = problem_of(options, observer, solver)
    return build_stages(atlas, options, problem, library, looks, colours, progress)


def _as_scene(
    scene: SceneLike | StrPath | Sequence[StrPath] | None,
) -> SceneLike | None:
    """Return the colours of images, or another set of colours as it is."""
    if isinstance(scene, str | os.PathLike | Sequence):
        colours: SceneLike = extension("scene", "images")(scene)
        return colours
    return scene


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
    blend: seeds.Blend,
) -> Options:
    """Replace ``dim="auto"`` by the smallest lattice that keeps every entry, if it fits
    into memory.
    """
    axis, dim, lost = seeds.choose_lattice(
        problem, prior, blend, constraints.at_nodes, options.auto_tolerance
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


Learnt = tuple[Constraints, Prior, tuple[float, ...]]
"""Fitted entries, prior and relevance of the families, for lattices of any size."""


def learn(
    problem: Problem,
    entry_model: Model,
    measured: MeasuredEntries,
    families: Sequence[Family],
) -> Learnt:
    """Fit the entries and the prior."""
    # Entries p_i: min ‖g − m‖² + Σ |w ΔL*a*b*|² subject to r(p) = t
    # (docs/mathematics.md, 6). Prior c(x) = s(x) + d(x): smooth spectra, what families
    # deviate from them, and kriging of the entries (7).
    constraints = entries.fit_constraints(problem, entry_model, measured)
    base, relevance = learn_base(problem, families, constraints.at_nodes)
    return constraints, fit_prior(problem, constraints.at_nodes, base), relevance


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

    # The spectra: families of the library, entries of the atlas, and looks, which
    # become further entries.
    libraries = () if library is None else entries.read_libraries(library)
    families = entries.families_of(options, libraries, sensor)
    atlas = entries.as_atlas(atlas)
    measured, outside = entries.split_by_gamut(atlas, sensor)
    targets = None
    if looks is not None:
        targets_of = extension("looks", "targets")
        targets = targets_of(looks, entry_model, sensor, atlas.names, measured)
    constraints, prior, relevance = learn(problem, entry_model, measured, families)
    if options.neutral == "flat":
        prior = prior.with_flat_greys()
    if targets is not None:
        targets, constraints, prior = targets.fit(problem, constraints, prior)

    # The lattice, the boxes of the entries in it (8), and the nodes that start from
    # entries: c = w c_i + (1 − w) c(x).
    blend = _blend(options)
    is_chosen = options.dim == AUTO
    if is_chosen:
        options = _choose_lattice(options, problem, constraints, prior, blend)
    lattice = Lattice(axis_nodes(options.axis, int(options.dim)))
    rgb = constraints.at_nodes.rgb
    boxes = EntryBoxes(lattice, rgb, seeds.half_widths(lattice.to_steps(rgb)))
    seeded = seeds.seed(lattice, rgb)
    # The choice of the lattice has counted the entries that none keeps.
    crowded = () if is_chosen else seeded.crowded
    entries.warn_of_close(constraints.names, boxes.half_width, crowded)

    kept = None
    if scene is not None:
        kept = np.flatnonzero(scene.required_points(boxes, sensor, progress))
    points, improvements = _fit_nodes(
        options, problem, constraints, prior, seeded, kept, progress
    )
    _warn_of_unfitted(options, points)
    if kept is not None:
        points = points.restricted_to(kept)

    outside_width = seeds.outside_half_widths(lattice, outside.rgb)
    entries.warn_of_close(outside.names, outside_width)
    table = _atlas_table(problem, constraints, prior, boxes, measured)
    table = replace(
        table,
        outside=_outside_table(problem, prior, entry_model, outside, outside_width),
    )
    provenance = {
        "uplift": version(),
        "options": options.record(),
        **_describe_atlas(atlas, outside),
        "prior": _describe_prior(prior),
        "improvements": improvements,
        **({} if scene is None else {"scene": scene.describe()}),
        **_describe_library(libraries, families, relevance),
        **({} if targets is None else targets.describe(table, problem.model, sensor)),
    }
    data = CubeData(
        model=problem.model,
        lattice=lattice,
        sensor=sensor,
        threshold=options.threshold,
        atlas=table,
        points=points if options.debug else replace(points, round=None),
        error_illuminant=ERROR_ILLUMINANT,
        provenance=provenance,
    )
    return Cube(data)


def _blend(options: Options) -> seeds.Blend:
    """Return how corners of the cells of entries start, with `seed_corners` as in the
    thesis.
    """
    if options.seed_corners or options.growth == "neighbours":
        return seeds.FULL_ENTRY
    return seeds.HALF_ENTRY


def _fit_nodes(
    options: Options,
    problem: Problem,
    constraints: Constraints,
    prior: Prior,
    seeded: seeds.Seeds,
    kept: Indices | None,
    progress: ProgressCallback,
) -> tuple[PointTable, list[dict[str, Any]]]:
    """Fit the nodes ``kept``, or all, and describe the steps that improved them."""
    # They grow from the seeds: min |R⁻¹ (p − p₀)|² subject to r(p) = t (5, 7), where t
    # is the nearest colour that some reflectance has (9).
    nodes = nodes_of(seeded.lattice, problem.sensor, kept)
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
    return store(grown, seeded, prior), improvements


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
    half_width: Array,
) -> AtlasTable | None:
    """Return the table of the entries outside the RGB space, if there are any.

    They constrain no node: their spectra answer XYZ and textures of other spaces.
    """
    if not outside.names:
        return None
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


def _describe_atlas(atlas: Atlas, outside: MeasuredEntries) -> dict[str, Any]:
    """Return the provenance of the entries, in JSON values."""
    return {
        "atlases": [
            {"name": source.name, "digest": source.digest, **source.changed_options()}
            for source in atlas.sources
        ],
        "left_out": list(outside.names),
        "skipped": [entry.name for entry in atlas.skipped],
    }


def _describe_prior(prior: Prior) -> dict[str, Any]:
    """Return what the kriging learnt, and the errors if the atlas is large enough."""
    learnt = {} if prior.kriging is None else prior.kriging.kernel._asdict()
    if prior.errors is not None:
        standard, bound = prior.errors.radii
        learnt["error_bound"] = bound / standard
    return learnt


def _describe_library(
    libraries: Sequence[tuple[Source, Atlas]],
    families: Sequence[Family],
    relevance: Sequence[float],
) -> dict[str, Any]:
    """Return the provenance of the learnt prior, in JSON values."""
    return {
        "libraries": [
            {"name": source.name, "digest": source.digest} for source, _ in libraries
        ],
        "families": [
            {"name": family.name, "relevance": weight}
            for family, weight in zip(families, relevance, strict=True)
        ],
    }
