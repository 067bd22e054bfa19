"""`build`: the options of a cube, and where its spectra come from."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Unpack

from uplift.common.arrays import StrPath
from uplift.common.extensions import extension
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.lookup.cube import Cube
from uplift.pipeline.entries import AtlasLike
from uplift.pipeline.options import OptionKeywords, Options, check_memory
from uplift.pipeline.stages import SceneLike, build_stages, problem_of


def build(
    atlas: AtlasLike = None,
    options: Options | None = None,
    *,
    library: AtlasLike = None,
    looks: Any = None,
    scene: SceneLike | StrPath | Sequence[StrPath] | None = None,
    progress: ProgressCallback = ignore_progress,
    **named: Unpack[OptionKeywords],
) -> Cube:
    """Build a spectral uplifting cube, constrained by measured spectra if an atlas is
    given.

    Parameters
    ----------
    atlas : Atlas, path-like or sequence of path-like, optional
        Measured spectra, or the files that contain them.
    options : Options, optional
        Options of the cube; the default ones by default.
    library : Atlas, path-like or sequence of path-like, optional
        Measured spectra that shape the learnt prior but are not constraints. Each file
        is a family of materials like those to be expected; with an atlas, its weight is
        learnt.
    looks : Look, path-like or sequence of Look, optional
        Colours and what they are to be under other lights, or a TOML file of them; see
        `uplift.Look`. Each is an entry of the cube like a measured one. Colours near it
        follow.
    scene : SceneLike, path-like or sequence of path-like, optional
        Images, or another set of colours. Only the nodes that answer these colours are
        fitted.
    progress : callable, optional
        Called with `Progress` events of the stages ``"images"``, ``"fit"`` and
        ``"store"``.
    **named
        Fields of `Options` by name, in place of those of ``options``, such as ``dim``.

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
    given: dict[str, Any] = {**named}
    options = replace(options or Options(), **given)
    check_memory(options)
    colours: Any = scene
    if isinstance(scene, str | os.PathLike | Sequence):
        colours = extension("scene", "images")(scene)
    options, problem = problem_of(options)
    return build_stages(
        atlas,
        options,
        problem,
        library=library,
        looks=looks,
        scene=colours,
        progress=progress,
    )
