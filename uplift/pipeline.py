"""The whole order: atlas → seeds → lattice → cube. The only module that knows all stages."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import asdict, replace
from importlib.metadata import version
from typing import Any

import numpy as np

from uplift import fit, observer
from uplift.atlas import Spectra, on_grid, read_atlas
from uplift.cube import AtlasTable, CubeData
from uplift.errors import UpliftWarning
from uplift.lattice import Lattice, Status
from uplift.lookup import Cube
from uplift.models import Model, reflectance
from uplift.models.least_change import forward
from uplift.options import Options, check_size
from uplift.sensor import Array, Sensor

BLOCK = 16384
"""Lattice points evaluated at a time."""

Atlas = Spectra | str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None


def build(atlas: Atlas = None, *, watch: fit.Watch = lambda done: None, **options: Any) -> Cube:
    """Build a cube, constrained by measured spectra if any are given.

    Parameters
    ----------
    atlas : spectra, or the file or files that hold them; None for a cube without constraints.
    watch : called after every round of growth with a `uplift.fit.Round`.
    options : the fields of `Options`, by name.

    Raises
    ------
    UpliftError : an atlas that cannot be read, an unknown name, an option outside its range.

    Warns
    -----
    UpliftWarning : naming every entry that is left out, clipped, or shares its lattice point.
    """
    chosen = Options(**options)
    check_size(chosen)
    model = chosen.spectrum_model()
    sensor = observer.sensor(chosen.space, chosen.illuminant, chosen.observer)
    lattice = Lattice(observer.axis_nodes(chosen.axis, chosen.dim))
    spectra = _read(atlas)
    names, rgb, measured = _in_gamut(spectra, sensor)
    seeds = fit.seed(lattice, rgb)
    _warn_of_collisions(seeds, names, rgb, chosen)

    ahead = forward(model, sensor.wavelengths, sensor.matrix)
    problem = fit.Problem(model, ahead, lattice, chosen.threshold)
    lights = [observer.light(name, chosen.observer) for name in chosen.lights]
    entries = fit.fit_entries(model, ahead, measured, rgb, lights, problem.tolerance)
    fitted = fit.fit_lattice(problem, seeds, entries, watch)
    atlas_table = AtlasTable(names, rgb, model.to_storage(entries))
    data = _cube_data(problem, sensor, fitted, atlas_table, _provenance(chosen, spectra, names, fitted))
    return Cube(data if chosen.debug else replace(data, round=None))


def _cube_data(
    problem: fit.Problem,
    sensor: Sensor,
    fitted: fit.Fit,
    atlas: AtlasTable,
    provenance: dict[str, Any],
) -> CubeData:
    """What is stored, judged by what is stored: RGB, distance and status are those any reader will see."""
    coefficients = problem.model.to_storage(fitted.multipliers)
    rgb = _lattice_rgb(problem.model, sensor, coefficients)
    distance = np.abs(rgb - problem.lattice.points).max(axis=1)
    missed = distance > problem.threshold
    return CubeData(
        model=problem.model,
        lattice=problem.lattice,
        sensor=sensor,
        threshold=problem.threshold,
        atlas=atlas,
        coefficients=coefficients,
        rgb=rgb.astype(np.float32),
        distance=distance.astype(np.float32),
        status=np.where(missed, Status.UNFITTED, fitted.status).astype(np.uint8),
        entry=fitted.entry.astype(np.int32),
        round=fitted.round.astype(np.int16),
        provenance=provenance,
    )


def _lattice_rgb(model: Model, sensor: Sensor, coefficients: Array) -> Array:
    """Linear RGB (n, 3) of stored coefficients (n, C), block by block."""
    blocks = np.array_split(coefficients, -(-len(coefficients) // BLOCK))
    return np.concatenate([sensor.rgb(reflectance(model, block, sensor.wavelengths)) for block in blocks])


def _read(atlas: Atlas) -> Spectra:
    if isinstance(atlas, Spectra):
        return atlas
    if atlas is None:
        return Spectra()
    return read_atlas(atlas) if isinstance(atlas, str | os.PathLike) else read_atlas(*atlas)


def _in_gamut(spectra: Spectra, sensor: Sensor) -> tuple[tuple[str, ...], Array, Array]:
    """Names, linear RGB (E, 3) and reflectances (E, N) of the entries within the space; the rest is named."""
    measured = on_grid(spectra, sensor.wavelengths)
    rgb = sensor.rgb(measured)
    inside = sensor.holds(rgb)
    for row in np.flatnonzero(~inside):
        values = ", ".join(f"{value:.4f}" for value in rgb[row])
        _warn(f"entry '{spectra.names[row]}' is left out: its colour ({values}) lies outside {sensor.space}")
    names = tuple(name for name, kept in zip(spectra.names, inside, strict=True) if kept)
    return names, np.clip(rgb[inside], 0, 1), measured[inside]


def _warn_of_collisions(seeds: fit.Seeds, names: tuple[str, ...], rgb: Array, options: Options) -> None:
    for kept, lost in seeds.collisions:
        dim = fit.separating_dim(
            rgb[kept], rgb[lost], lambda dim: observer.axis_nodes(options.axis, dim), options.dim
        )
        advice = f"--dim {dim} would separate them" if dim else "no dim up to 256 separates them"
        _warn(
            f"entries '{names[kept]}' and '{names[lost]}' share their nearest lattice point; "
            f"it goes to '{names[kept]}'; {advice}"
        )


def _warn(message: str) -> None:
    warnings.warn(message, UpliftWarning, stacklevel=4)


def _provenance(
    options: Options, spectra: Spectra, names: tuple[str, ...], fitted: fit.Fit
) -> dict[str, Any]:
    """How the cube was made, in JSON values."""
    return {
        "uplift": version("uplift"),
        "options": asdict(options) | {"lights": list(options.lights)},
        "atlases": [{"name": source.name, "digest": source.digest} for source in spectra.sources],
        "left_out": [name for name in spectra.names if name not in names],
        "skipped": [entry.name for entry in spectra.skipped],
        "improvements": [asdict(step) for step in fitted.improvements],
    }
