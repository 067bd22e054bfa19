"""`build`: the options of a cube, and where its spectra come from."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal

from uplift.colorimetry import observer as observers
from uplift.colorimetry.camera import Camera
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT, SCENE_LIGHTS, Illuminant
from uplift.common.arrays import StrPath
from uplift.common.extensions import extension
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.lookup.cube import Cube
from uplift.models.moments import MAX_COUNT
from uplift.pipeline.entries import AtlasLike
from uplift.pipeline.options import (
    CUSTOM,
    GrowthName,
    ModelName,
    NeutralName,
    Options,
    PriorName,
    check_memory,
)
from uplift.pipeline.stages import SceneLike, build_stages, problem_of


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
    trust_atlas: bool = False,
    exact_entries: bool = False,
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
        With ``dim="auto"``: largest ΔE00, under ``lights``, between an entry and a
        lattice whose nodes around each entry start from it, which so has room for all.
    seed_corners : bool, default False
        Start all eight corners of the cell of each atlas entry from the entry, as
        Tódová 2020 does. By default, they start between entry and prior, and nearer to
        the prior at colours unlike the entry's and where other entries are close.
        ``growth="neighbours"`` always does.
    trust_atlas : bool, default False
        Expect every material to be like those of the atlas. By default the prior trusts
        an atlas only as far as its own entries are the better predicted, so that it
        does not mislead about other materials (docs/prior.md).
    exact_entries : bool, default False
        Keep the exact spectra of entries that contradict their surroundings. By default
        they are smoothed where they would show as spots under other lights, and nodes
        near entries are moved towards their neighbours where gradients would be steep.
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
        Entries with the colour of an earlier entry, which are left out
        (``entry-duplicate``), close to another entry (``entry-crowded``) or unlike all
        others of close colours (``entry-smoothed``). Spectra of a library out of gamut
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
        trust_atlas=trust_atlas,
        exact_entries=exact_entries,
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
