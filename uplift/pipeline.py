"""The whole order: atlas → seeds → lattice → cube. The only module that knows all stages."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from uplift import __version__, fit, observer
from uplift.atlas import Spectra, on_grid, read_atlas
from uplift.cube import AtlasTable, CubeData
from uplift.errors import OptionError, UpliftWarning
from uplift.lattice import Lattice, Status
from uplift.lookup import Cube
from uplift.models import Model, Moments, Phase, Sigmoid
from uplift.models.least_change import forward
from uplift.sensor import Array, Sensor

MODELS = ("moments", "sigmoid")

Atlas = Spectra | str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None


@dataclass(frozen=True)
class Options:
    """What a build can be told; recorded in the cube, so that it can be made again.

    ``coefficients`` counts moments + 1 (3 to 17; the sigmoid has 3); ``lights`` are those that the atlas
    entries' colours should hold under; ``threshold`` is the largest |linear RGB| a lattice point may miss
    its target by.
    """

    dim: int = 32
    model: str = "moments"
    coefficients: int = 9
    warp: str = "none"
    axis: str = "srgb"
    space: str = "sRGB"
    illuminant: str = "D65"
    observer: str = observer.DEFAULT_OBSERVER
    lights: tuple[str, ...] = ("D65", "A", "FL2", "FL11")
    threshold: float = 1e-4
    debug: bool = False

    def spectrum_model(self) -> Model:
        """Raises `OptionError`."""
        if self.model == Moments.name:
            return Moments(self.coefficients, Phase(observer.START, observer.END, self.warp))
        if self.model == Sigmoid.name:
            return Sigmoid(observer.START, observer.END)
        raise observer.suggest(self.model, MODELS, "model")


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
    lights = [observer.light(name, chosen.observer) for name in chosen.lights]
    entries = fit.fit_entries(model, ahead, measured, rgb, lights, chosen.threshold / 100)
    fitted = fit.fit_lattice(model, ahead, lattice, seeds, entries, threshold=chosen.threshold, watch=watch)
    stored = model.to_storage(fitted.multipliers)
    back = sensor.rgb(model.squash(model.from_storage(stored) @ ahead.basis.T))
    distance = np.abs(back - lattice.points).max(axis=1)
    data = CubeData(
        model=model,
        lattice=lattice,
        sensor=sensor,
        threshold=chosen.threshold,
        atlas=AtlasTable(names, rgb, model.to_storage(entries)),
        coefficients=stored,
        rgb=back.astype(np.float32),
        distance=distance.astype(np.float32),
        status=np.where(distance > chosen.threshold, Status.UNFITTED, fitted.status).astype(np.uint8),
        entry=fitted.entry.astype(np.int32),
        round=fitted.round.astype(np.int16) if chosen.debug else None,
        provenance=_provenance(chosen, spectra, names, fitted),
    )
    return Cube(data)


def check_size(options: Options) -> None:
    """Raises `OptionError` for a lattice too small to be one, or too large for this machine's memory."""
    if options.dim < 2:
        raise OptionError(f"a lattice of dim {options.dim} has no cells", remedy="use --dim 2 or more")
    if not 0 < options.threshold <= 0.1:
        raise OptionError(f"a threshold of {options.threshold:g} makes no sense", remedy="use 1e-6 to 0.1")
    count = options.spectrum_model().count
    need, have = _bytes_needed(options.dim, count), _memory()
    if need > have:
        largest = int((have / _bytes_needed(1, count)) ** (1 / 3))
        raise OptionError(
            f"dim {options.dim} needs about {need / 1e9:.3g} GB of memory, this machine has {have / 1e9:.3g} GB",
            remedy=f"use --dim {largest} or less",
        )


def _bytes_needed(dim: int, count: int) -> int:
    """Peak memory: five arrays of multipliers or coefficients, and what else a point carries."""
    return int(dim) ** 3 * (5 * 8 * count + 250)


def _memory() -> int:
    """Bytes of memory in this machine; where it does not tell, as if there were no end to it."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return 1 << 62


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
        "uplift": __version__,
        "options": asdict(options) | {"lights": list(options.lights)},
        "atlases": [{"name": source.name, "digest": source.digest} for source in spectra.sources],
        "left_out": [name for name in spectra.names if name not in names],
        "skipped": [entry.name for entry in spectra.skipped],
        "improvements": [asdict(step) for step in fitted.improvements],
    }
