"""The whole order: atlas → seeds → lattice → cube. The only module that knows all stages."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import asdict, replace
from importlib.metadata import version
from typing import Any

import numpy as np

from uplift import fit
from uplift.atlas import Atlas, on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.threads import single_threaded_blas
from uplift.cube import AtlasTable, CubeData
from uplift.io.scene_colours import Scene, SceneLike, as_scene
from uplift.lattice import Lattice
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lookup import Cube
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap, forward_map
from uplift.pipeline.options import AUTO, AXES, Options, check_size

NAMED = 6
"""Entries that a warning names."""

REFERENCE = "A"
"""The light that standard errors are stated under."""

AtlasLike = Atlas | str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None


@single_threaded_blas()
def build(
    atlas: AtlasLike = None,
    *,
    scene: SceneLike | None = None,
    progress: ProgressCallback = ignore_progress,
    **options: Any,
) -> Cube:
    """Build a cube, constrained by measured spectra if any are given.

    Parameters
    ----------
    atlas : spectra, or the file or files that hold them; None for a cube without constraints.
    scene : images, or a `uplift.io.scene_colours.Scene`, for whose colours alone to fit points; None for all.
    progress : called with a `Progress` now and then, in stages "images", "fit" and "store".
    options : the fields of `Options`, by name.

    Raises
    ------
    UpliftError : an atlas that cannot be read, an unknown name, an option outside its range.

    Warns
    -----
    UpliftWarning : naming every entry that is left out, clipped, or crowded, and images of another space.
    """
    chosen = Options(**options)
    model = chosen.spectrum_model()
    sensor = observer.sensor(chosen.space, chosen.illuminant, chosen.observer)
    spectra = _read(atlas)
    names, rgb, measured = _in_gamut(spectra, sensor)
    lights = [observer.light(name, chosen.observer) for name in chosen.lights]
    reference = observer.light(REFERENCE, chosen.observer)

    ahead = forward_map(model, sensor.wavelengths, sensor.matrix)
    entries = fit.fit_entries(model, ahead, measured, rgb, lights, reference, chosen.threshold / 100)
    axis, dim = _room(chosen, model, ahead, sensor, lights, entries)
    check_size(replace(chosen, dim=dim))
    lattice = Lattice(observer.axis_nodes(axis, dim))
    reach = fit.half_widths(lattice, rgb)
    seen = None if scene is None else as_scene(scene)
    wanted = (
        None
        if seen is None
        else np.flatnonzero(seen.points(EntryBoxes(lattice, rgb, reach), sensor, progress))
    )
    beyond = fit.unrealisable(lattice, sensor, chosen.threshold / 2, wanted)
    problem = fit.Problem(model, ahead, lattice, chosen.threshold, beyond, wanted)
    seeds = fit.seed(lattice, rgb)
    table = AtlasTable(names, rgb, model.to_storage(entries.multipliers), reach, entries.error)
    _warn_of_crowding(seeds, table)
    prior = fit.fit_prior(problem, sensor, entries, reference)
    fitted = fit.fit_lattice(problem, seeds, entries.multipliers, prior, progress)
    provenance = _provenance(replace(chosen, axis=axis, dim=dim), spectra, names, seen, fitted)
    return Cube(_cube_data(problem, sensor, fitted, table, provenance, debug=chosen.debug))


def _room(
    chosen: Options,
    model: Model,
    ahead: ForwardMap,
    sensor: Sensor,
    lights: list[Light],
    entries: fit.FittedEntries,
) -> tuple[str, int]:
    """Axis and dim as asked for or, if so asked, the smallest that has room for the atlas."""
    if chosen.dim != AUTO:
        return chosen.axis, chosen.dim
    problem = fit.Problem(model, ahead, Lattice(observer.axis_nodes(chosen.axis, 2)), chosen.threshold)
    axis, dim, lost = fit.choose_lattice(
        problem, sensor.wavelengths, lights, entries, observer.axis_nodes, AXES, chosen.within
    )
    if lost:
        _warn(
            f"no dim up to {fit.DIMS[-1]} keeps every entry within ΔE00 {chosen.within:g}: {lost} of "
            f"{len(entries.rgb)} stand too close to others; dim {dim} keeps the most"
        )
    return axis, dim


def _cube_data(
    problem: fit.Problem,
    sensor: Sensor,
    fitted: fit.Fit,
    atlas: AtlasTable,
    provenance: dict[str, Any],
    *,
    debug: bool,
) -> CubeData:
    return CubeData(
        model=problem.model,
        lattice=problem.lattice,
        sensor=sensor,
        threshold=problem.threshold,
        atlas=atlas,
        points=fitted.points if debug else replace(fitted.points, round=None),
        error_illuminant=REFERENCE,
        provenance=provenance,
    )


def _read(atlas: AtlasLike) -> Atlas:
    if isinstance(atlas, Atlas):
        return atlas
    if atlas is None:
        return Atlas()
    return read_atlas(atlas) if isinstance(atlas, str | os.PathLike) else read_atlas(*atlas)


def _in_gamut(spectra: Atlas, sensor: Sensor) -> tuple[tuple[str, ...], Array, Array]:
    """Names, linear RGB (E, 3) and reflectances (E, N) of the entries within the space; the rest is named."""
    measured = on_grid(spectra, sensor.wavelengths)
    rgb = sensor.rgb(measured)
    inside = sensor.contains(rgb)
    for row in np.flatnonzero(~inside):
        values = ", ".join(f"{value:.4f}" for value in rgb[row])
        _warn(f"entry '{spectra.names[row]}' is left out: its colour ({values}) lies outside {sensor.space}")
    names = tuple(name for name, kept in zip(spectra.names, inside, strict=True) if kept)
    return names, np.clip(rgb[inside], 0, 1), measured[inside]


def _warn_of_crowding(seeds: fit.Seeds, atlas: AtlasTable) -> None:
    same = [atlas.names[row] for row in np.flatnonzero(atlas.half_width == 0)]
    if same:
        _warn(
            f"{_some(same)} left out: an earlier entry has the same colour, and a cube answers a colour once"
        )
    crowded = [
        atlas.names[collision.lost] for collision in seeds.collisions if atlas.half_width[collision.lost]
    ]
    if crowded:
        _warn(
            f"{_some(crowded)} crowded: nearer entries have the nearest lattice point. Asked at their own colours "
            "all entries are exact, beside them less so; --dim auto finds a dim with room, 'uplift report' tells more"
        )


def _some(names: list[str]) -> str:
    """'entry 'a' is', 'entries 'a', 'b', 'c' and 12 more are'."""
    shown = ", ".join(f"'{name}'" for name in names[:NAMED])
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"entry {shown} is" if len(names) == 1 else f"entries {shown}{more} are"


def _warn(message: str) -> None:
    warnings.warn(message, UpliftWarning, stacklevel=5)


def _provenance(
    options: Options, spectra: Atlas, names: tuple[str, ...], scene: Scene | None, fitted: fit.Fit
) -> dict[str, Any]:
    """How the cube was made, in JSON values."""
    return {
        "uplift": version("uplift"),
        "options": asdict(options) | {"lights": list(options.lights)},
        "atlases": [{"name": source.name, "digest": source.digest} for source in spectra.sources],
        "left_out": [name for name in spectra.names if name not in names],
        "skipped": [entry.name for entry in spectra.skipped],
        "improvements": [asdict(step) for step in fitted.improvements],
        **({} if scene is None else {"scene": scene.describe()}),
    }
