"""The order of a build: atlas → fitted entries → lattice → prior → fitted points → cube."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from uplift import fit
from uplift.atlas import Atlas
from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT, ERROR_ILLUMINANT, SCENE_LIGHTS
from uplift.common.arrays import Array, StrPath
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.threads import single_threaded_blas
from uplift.common.version import VERSION
from uplift.cube import CubeData
from uplift.lattice import EntryBoxes, Lattice, SceneLike
from uplift.lattice.box_widths import half_widths
from uplift.lookup import Cube
from uplift.models.moments import MAX_COUNT
from uplift.pipeline.constraints import Constraints, fit_constraints
from uplift.pipeline.entries import as_atlas, entries_in_gamut, warn
from uplift.pipeline.libraries import AtlasLike, read_libraries
from uplift.pipeline.libraries import describe as describe_libraries
from uplift.pipeline.libraries import families as library_families
from uplift.pipeline.looks import LooksLike, as_looks, resolve_looks
from uplift.pipeline.looks import describe as describe_looks
from uplift.pipeline.options import (
    AUTO,
    AXES,
    CUSTOM,
    ModelName,
    Options,
    PriorName,
    SolverName,
    check_memory,
)
from uplift.pipeline.provenance import describe_source
from uplift.pipeline.setting import Setting, make_setting

if TYPE_CHECKING:
    from uplift.fit.stock_solver import Solver

MAX_NAMES = 6
"""Entries that a warning names."""


@single_threaded_blas()
def build(
    atlas: AtlasLike = None,
    *,
    dim: int | Literal["auto"] = 32,
    model: ModelName = "moments",
    coefficients: int = 9,
    entry_coefficients: int = MAX_COUNT,
    warp: Literal["none", "vision"] = "none",
    axis: Literal["srgb", "linear"] = "srgb",
    space: str = "sRGB",
    illuminant: str = DEFAULT_ILLUMINANT,
    observer: str | Camera = observers.DEFAULT_OBSERVER,
    shortest: float = observers.START,
    longest: float = observers.END,
    step: float = observers.STEP,
    lights: Sequence[str] = SCENE_LIGHTS,
    prior: PriorName = "learnt",
    library: AtlasLike = None,
    looks: LooksLike = None,
    leave_out: Sequence[str] = (),
    threshold: float = 1e-4,
    auto_tolerance: float = 0.5,
    seed_corners: bool = False,
    start: Literal["prior", "neighbours"] = "prior",
    solver: SolverName | Solver = "least-change",
    debug: bool = False,
    scene: SceneLike | StrPath | Sequence[StrPath] | None = None,
    progress: ProgressCallback = ignore_progress,
) -> Cube:
    """Build a spectral uplifting cube, constrained by measured spectra if an atlas is given.

    Parameters
    ----------
    atlas : Atlas, path-like or sequence of path-like, optional
        Measured spectra, or the files that contain them.
    dim : int or {"auto"}, default 32
        Lattice points along each axis, at least 2. ``"auto"`` chooses the smallest lattice, and its axis, that
        keeps every atlas entry within ``auto_tolerance``.
    model : {"moments", "sigmoid"}, default "moments"
        Spectrum model: bounded trigonometric moments, or the sigmoid of a quadratic.
    coefficients : int, default 9
        Coefficients per spectrum of the moment model, 3 to 17: the number of moments plus one. The sigmoid has 3.
    entry_coefficients : int, default 17
        Coefficients of the spectra of atlas entries in the moment model, from ``coefficients`` to 17. Entries are few,
        so more of them cost little, and the answers at and near the colours of entries come closer to the measurements.
    warp : {"none", "vision"}, default "none"
        Map from wavelengths to the phase of the moments. ``"vision"`` resolves wavelengths by the sensitivity
        of the eye.
    axis : {"srgb", "linear"}, default "srgb"
        Spacing of the axis nodes: equal steps of the sRGB encoding, or of linear RGB.
    space : str, default "sRGB"
        RGB space of queries, by its name in colour-science, or ``"camera"``: raw values of a camera, balanced so that
        a perfect white under the illuminant is (1, 1, 1).
    illuminant : str, default "D65"
        Illuminant under which reflectances have their RGB.
    observer : str or Camera, default "CIE 1931 2 Degree Standard Observer"
        Colour-matching functions, by their name in colour-science. With ``space="camera"`` a camera: its name in
        colour-science, a CSV file of its sensitivities, or a `Camera`.
    shortest, longest : float, default 380 and 780
        Range of the spectra in nm, at most 300 to 1000. Outside the range of an entry, its spectrum continues as a
        constant, and so does the learnt prior outside 380 to 780; outside the range of the cube, every spectrum does.
        The coefficients are shared by the whole range, so a much wider one resolves less (docs/accuracy.md).
    step : {1, 5, 10}, default 5
        Distance in nm of the wavelengths at which spectra are integrated and compared.
    lights : sequence of str, default ("D65", "A", "FL2", "FL11", "LED-B3")
        Illuminants under which fitted atlas entries must keep their measured colours.
    prior : {"learnt", "smooth"}, default "learnt"
        Spectra of colours that no entry constrains: those expected of real materials, or smooth ones.
    library : Atlas, path-like or sequence of path-like, optional
        Measured spectra that shape the learnt prior but are not constraints. Each file is a family of materials like
        those to be expected; with an atlas, its weight is learnt.
    looks : Look, path-like or sequence of Look, optional
        Colours and what they are to be under other lights, or a TOML file of them; see `uplift.Look`. Each is an entry
        of the cube like a measured one. Colours near it follow.
    leave_out : sequence of str, optional
        Families of the shipped library that the learnt prior must not know, for tests on them; see
        `uplift.fit.shipped_library`.
    threshold : float, default 1e-4
        Largest ``|target − stored|`` of a fitted lattice point in linear RGB, in (0, 0.1].
    auto_tolerance : float, default 0.5
        With ``dim="auto"``: largest ΔE00, under ``lights``, between an entry and the lattice.
    seed_corners : bool, default False
        Start all eight corners of the cell of each atlas entry from the entry, as Tódová 2020 does. By default, seven
        of them start between entry and prior, with a share of the entry from ½ to 1 that the nugget of the atlas
        determines, and less, down to 0, at colours unlike the entry's; see `uplift.fit.Prior.corner_share`.
        ``start="neighbours"`` always does.
    start : {"prior", "neighbours"}, default "prior"
        What lattice points start from: the spectrum that the atlas lets expect at their colour, or the spectra of
        their fitted neighbours, outward from the seeds (Tódová 2020, section 3.1).
    solver : str or optimistix.AbstractLeastSquaresSolver, default "least-change"
        Solver of lattice points and entries: ``"least-change"``, ``"dogleg"``, ``"levenberg-marquardt"``,
        ``"gauss-newton"``, or any least-squares solver of optimistix. The default is fastest; answers agree
        except for nearly box-shaped spectra (docs/growth.md).
    debug : bool, default False
        Store the round of growth in which each point was fitted.
    scene : SceneLike, path-like or sequence of path-like, optional
        Images, or another set of colours. Only the lattice points that answer these colours are fitted.
    progress : callable, optional
        Called with `Progress` events of the stages ``"images"``, ``"fit"`` and ``"store"``.

    Returns
    -------
    Cube
        The cube, ready for queries; `Cube.save` writes it.

    Raises
    ------
    AtlasError
        An atlas file that cannot be read.
    OptionError
        An option outside its range, or a library without a learnt prior.
    LookError
        A look that cannot be read, has the colour or the name of an entry or of another look, or needs a model with
        more coefficients.
    UnknownNameError
        An unknown space, illuminant, observer, model, axis, prior, family, start or solver.

    Warns
    -----
    UpliftWarning
        Entries out of gamut (``entry-out-of-gamut``), with the colour of another entry (``entry-duplicate``) or
        close to another entry (``entry-crowded``). Spectra of a library out of gamut (``library-out-of-gamut``) or
        outside [0, 1] (``library-clipped``). Looks that no reflectance meets (``look-impossible``), or that the
        coefficients of entries do not reach (``look-not-reached``); the nearest colour is used.

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
        lights=(lights,) if isinstance(lights, str) else tuple(lights),
        prior=prior,
        leave_out=(leave_out,) if isinstance(leave_out, str) else tuple(leave_out),
        threshold=threshold,
        auto_tolerance=auto_tolerance,
        seed_corners=seed_corners,
        start=start,
        solver=solver if isinstance(solver, str) else CUSTOM,
        debug=debug,
    )
    check_memory(options)
    setting = make_setting(options, observer, solver)
    options = setting.options
    scene = None if scene is None else _as_scene(scene)
    libraries = read_libraries(library)
    families = library_families(setting.options, libraries, setting.sensor)
    atlas = as_atlas(atlas)
    measured = entries_in_gamut(atlas, setting.sensor)
    wished = resolve_looks(
        as_looks(looks), setting.entry_model, setting.sensor, atlas.names, measured.names, measured.rgb
    )

    constraints = fit_constraints(setting, measured, wished, families)
    corner_share = _corner_share(options, constraints.prior)
    options = _with_dim(setting, constraints, corner_share)
    placed = _place(options, constraints.rgb)
    _warn_of_crowding(constraints.names, placed)
    starts = fit.Starts(constraints.prior, placed.seeds, _seed_multipliers(options, constraints), corner_share)
    fitted = _fit_nodes(setting, placed, starts, scene, progress)

    table = constraints.table(placed.boxes)
    recorded = _provenance(options, atlas, measured.names, scene, starts, fitted)
    recorded |= describe_libraries(libraries, families, constraints.relevance)
    recorded |= describe_looks(constraints.looks, table, setting.model, setting.sensor)
    return Cube(
        CubeData(
            model=setting.model,
            lattice=placed.lattice,
            sensor=setting.sensor,
            threshold=options.threshold,
            atlas=table,
            points=fitted.points if options.debug else replace(fitted.points, round=None),
            error_illuminant=ERROR_ILLUMINANT,
            provenance=recorded,
        )
    )


def _corner_share(options: Options, prior: fit.Prior) -> fit.CornerShare:
    alone = options.seed_corners or options.start == "neighbours"
    return fit.ENTRY_ALONE if alone else prior.corner_share


def _seed_multipliers(options: Options, constraints: Constraints) -> Array:
    """Multipliers (E, C) that seeds start from; growth from neighbours takes them as the thesis does."""
    return constraints.recalculated() if options.start == "neighbours" else constraints.at_nodes.multipliers


@dataclass(frozen=True, eq=False)
class _Placed:
    """Constraints in a lattice: regions with their spectra, and the points that start from them."""

    lattice: Lattice
    boxes: EntryBoxes
    seeds: fit.Seeds


def _place(options: Options, rgb: Array) -> _Placed:
    lattice = Lattice(observers.axis_nodes(options.axis, int(options.dim)))
    return _Placed(lattice, EntryBoxes(lattice, rgb, half_widths(lattice, rgb)), fit.seed(lattice, rgb))


def _fit_nodes(
    setting: Setting,
    placed: _Placed,
    starts: fit.Starts,
    scene: SceneLike | None,
    progress: ProgressCallback,
) -> fit.LatticeFit:
    """Fit all points of the lattice, or those that a scene needs."""
    lattice, sensor, strategy = placed.lattice, setting.sensor, fit.STRATEGIES[setting.options.start]
    kept = None if scene is None else np.flatnonzero(scene.required_points(placed.boxes, sensor, progress))
    active = None if kept is None else strategy.supporting_points(lattice, kept)
    outside = fit.unrealisable(lattice, sensor, setting.options.threshold / 2, active)
    problem = replace(setting.problem, lattice=lattice, unrealisable=outside, active_points=active)
    fitted = fit.fit_lattice(problem, starts, progress, strategy)
    return fitted if kept is None else replace(fitted, points=fitted.points.restricted_to(kept))


def _as_scene(scene: SceneLike | StrPath | Sequence[StrPath]) -> SceneLike:
    """Paths as `uplift.io.scene_colours.Images`, imported only for them: a build without images needs no image code."""
    if isinstance(scene, str | os.PathLike | Sequence):
        from uplift.io.scene_colours import Images

        paths = [scene] if isinstance(scene, str | os.PathLike) else scene
        return Images(tuple(Path(path) for path in paths))
    return scene


def _with_dim(setting: Setting, constraints: Constraints, corner_share: fit.CornerShare) -> Options:
    """Replace ``dim="auto"`` by the smallest lattice that keeps every entry, if it fits into memory."""
    options = setting.options
    if options.dim != AUTO:
        return options
    choice = fit.choose_lattice(
        setting.problem,
        constraints.prior,
        corner_share,
        setting.lights,
        constraints.at_nodes,
        observers.axis_nodes,
        AXES,
        options.auto_tolerance,
    )
    if choice.lost:
        warn(
            f"no dim up to {fit.DIMS[-1]} keeps every entry within ΔE00 {options.auto_tolerance:g}: "
            f"{choice.lost} of {len(constraints.rgb)} are too close to others; dim {choice.dim} keeps the most",
            "no-dim-keeps-all-entries",
        )
    options = replace(options, axis=choice.axis, dim=choice.dim)
    check_memory(options)
    return options


def _warn_of_crowding(names: Sequence[str], placed: _Placed) -> None:
    half_width, collisions = placed.boxes.half_width, placed.seeds.collisions
    duplicates = [names[row] for row in np.flatnonzero(half_width == 0).tolist()]
    crowded = [names[collision.lost] for collision in collisions if half_width[collision.lost]]
    if duplicates:
        warn(
            f"{_listed(duplicates)} left out: an earlier entry has the same colour, which has only one answer",
            "entry-duplicate",
        )
    if crowded:
        warn(
            f"{_listed(crowded)} crowded: closer entries own the nearest lattice point. Queries at the entries' own "
            "colours stay exact, queries near them are less accurate",
            "entry-crowded",
            hint='use dim="auto" for a lattice that is large enough, or see the report of the cube',
        )


def _listed(names: Sequence[str]) -> str:
    """'entry 'a' is', 'entries 'a', 'b', 'c' and 12 more are'."""
    shown = ", ".join(f"'{name}'" for name in names[:MAX_NAMES])
    more = f" and {len(names) - MAX_NAMES} more" if len(names) > MAX_NAMES else ""
    return f"entry {shown} is" if len(names) == 1 else f"entries {shown}{more} are"


def _provenance(
    options: Options,
    atlas: Atlas,
    names: tuple[str, ...],
    scene: SceneLike | None,
    starts: fit.Starts,
    fitted: fit.LatticeFit,
) -> dict[str, Any]:
    """How the cube was built, in JSON values."""
    return {
        "uplift": VERSION,
        "options": asdict(options) | {"lights": list(options.lights), "leave_out": list(options.leave_out)},
        "atlases": [describe_source(source) for source in atlas.sources],
        "left_out": [name for name in atlas.names if name not in names],
        "skipped": [entry.name for entry in atlas.skipped],
        "prior": starts.describe(),
        "improvements": [step.to_json() for step in fitted.improvements],
        **({} if scene is None else {"scene": scene.describe()}),
    }
