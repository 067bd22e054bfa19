"""Spectra of a build: the entries of its atlas and the families of its library, with
warnings of those not used.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.atlas.atlas import Atlas, Source
from uplift.atlas.resampling import on_grid, resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.observer import COMMON_SPACES, grid, smallest_space
from uplift.colorimetry.sensor import Sensor, in_unit_cube
from uplift.common.arrays import Array, Indices, StrPath
from uplift.common.errors import AtlasError, OptionError, UpliftWarning, warn
from uplift.common.text import format_value, listed
from uplift.cube.data import AtlasTable, EntrySpectra
from uplift.fit.entries import FittedEntries, fit_entries, with_multipliers
from uplift.fit.families import Family, shipped_library
from uplift.fit.problem import Problem
from uplift.models.model import Model
from uplift.pipeline.options import Options

AtlasLike = Atlas | StrPath | Sequence[StrPath] | None
"""An atlas, or the files of one."""

SPREAD = 1.0
"""See `uplift.fit.families.Family`; by held-out halves of large sets (docs/prior.md).
"""
RELATED = 0.5
"""Likewise."""
SAME_COLOUR = 1e-8
"""Step of linear RGB within which entries have the same colour."""


class MeasuredEntries(NamedTuple):
    """Names (E,) of atlas entries, their linear RGB (E, 3) and reflectances (E, N), all
    in [0, 1].
    """

    names: tuple[str, ...]
    rgb: Array
    reflectances: Array


@dataclass(frozen=True, eq=False)
class Spectra:
    """What shapes the prior of a build and constrains its answers."""

    libraries: tuple[tuple[Source, Atlas], ...]
    """Libraries of the user, and their files."""
    families: tuple[Family, ...]
    """Families of the shipped library, and of the user's."""
    atlas: Atlas
    measured: MeasuredEntries
    """Entries in the RGB space."""
    outside: MeasuredEntries
    """Entries outside the RGB space."""

    def describe(self) -> dict[str, Any]:
        """Return the provenance of the spectra, in JSON values."""
        return {
            "atlases": [
                {**_describe(source), **source.changed_options()}
                for source in self.atlas.sources
            ],
            "left_out": list(self.outside.names),
            "skipped": [entry.name for entry in self.atlas.skipped],
            "libraries": [_describe(source) for source, _ in self.libraries],
        }


def _describe(source: Source) -> dict[str, str]:
    return {"name": source.name, "digest": source.digest}


@dataclass(frozen=True, eq=False)
class Constraints:
    """The E entries of a cube, measured ones and then looks, in the spectrum models of
    the nodes and of entries.
    """

    names: tuple[str, ...]
    entry_model: Model
    at_nodes: FittedEntries
    at_entries: FittedEntries
    looks: int = 0

    @property
    def has_more(self) -> bool:
        """Whether entries have more coefficients than nodes."""
        return self.at_entries is not self.at_nodes and len(self.names) > 0

    @property
    def measured_count(self) -> int:
        """Number of entries without the looks."""
        return len(self.names) - self.looks

    def truncated(self, model: Model) -> Array:
        """Multipliers (E, C) of the spectra of entries with the coefficients of nodes.

        Fewer moments of the same spectrum are the first of them (Tódová 2020, section
        3.1.3).
        """
        if not self.has_more:
            return self.at_nodes.multipliers
        # c_j = (1/π) ∫ g cos jφ dφ for any count
        stored = self.entry_model.to_storage(self.at_entries.multipliers)
        return model.from_storage(stored[:, : model.count])

    def spectra(self, model: Model) -> EntrySpectra:
        """Return the spectra that answer the colours of the entries."""
        fitted = self.at_nodes
        if self.has_more:
            model = self.entry_model
            fitted = self.at_entries
        return EntrySpectra(model, model.to_storage(fitted.multipliers))

    def table(
        self, model: Model, half_width: Array, measured: NDArray[np.float32] | None
    ) -> AtlasTable:
        """Return the part of a cube that records the constraints."""
        return AtlasTable(
            names=self.names,
            rgb=self.at_nodes.rgb,
            coefficients=model.to_storage(self.at_nodes.multipliers),
            half_width=half_width,
            error=self.at_entries.error,
            spectra=self.spectra(model),
            measured=measured,
            looks=self.looks,
        )


def read_spectra(
    atlas: AtlasLike, library: AtlasLike, options: Options, sensor: Sensor
) -> Spectra:
    """Read the families of the library, and the entries of the atlas."""
    libraries = () if library is None else read_libraries(library)
    families = families_of(options, libraries, sensor)
    atlas = as_atlas(atlas)
    measured, outside = split_by_gamut(atlas, sensor)
    return Spectra(libraries, families, atlas, measured, outside)


def as_atlas(atlas: AtlasLike) -> Atlas:
    """Return an atlas as given, or read from one file or several."""
    if atlas is None or isinstance(atlas, Atlas):
        return Atlas() if atlas is None else atlas
    files = [atlas] if isinstance(atlas, str | os.PathLike) else atlas
    are_files = isinstance(files, Sequence) and all(
        isinstance(file, str | os.PathLike) for file in files
    )
    if not are_files:
        hint = "give uplift.Atlas((uplift.Entry(name, wavelengths, values), ...))"
        problem = f"an atlas is an Atlas, a file or files, got {format_value(atlas)}"
        raise AtlasError(problem, hint=hint)
    return read_atlas(*files)


def split_by_gamut(
    atlas: Atlas, sensor: Sensor
) -> tuple[MeasuredEntries, MeasuredEntries]:
    """Return the entries in the RGB space, and those outside; all outside are an error.
    Warn of entries whose colour an earlier one has, which are left out.
    """
    measured = on_grid(atlas, sensor.wavelengths)
    # t = W m of measured reflectances m
    rgb = sensor.rgb(measured)
    inside = in_unit_cube(rgb)
    rgb[inside] = np.clip(rgb[inside], 0, 1)
    if (atlas.entries or atlas.skipped) and not inside.any():
        space = smallest_space(
            resample(atlas, grid()).values, sensor.illuminant, sensor.observer
        )
        problem = (
            f"no entry of the atlas is within {sensor.space}: {len(atlas)} outside, "
            f"{len(atlas.skipped)} skipped"
        )
        hint = f"none of {', '.join(COMMON_SPACES)} holds all entries"
        if space is not None:
            hint = f'use space="{space}", which holds all entries'
        raise AtlasError(problem, code="atlas-out-of-gamut", hint=hint)
    names = np.array(atlas.names, dtype=object)
    colours = np.round(rgb / SAME_COLOUR)
    first = np.zeros(len(names), dtype=bool)
    first[np.unique(colours, axis=0, return_index=True)[1]] = True
    if not first.all():
        listing = _listed(names[~first].tolist())
        problem = (
            "left out: an earlier entry has the same colour, which has only one answer"
        )
        warn(UpliftWarning(f"{listing} {problem}", code="entry-duplicate"))
    within, outside = [
        MeasuredEntries(tuple(names[rows]), rgb[rows], measured[rows])
        for rows in (inside & first, ~inside & first)
    ]
    return within, outside


def fit_constraints(
    problem: Problem, entry_model: Model, entries: MeasuredEntries
) -> Constraints:
    """Fit measured entries by the models of nodes and of entries, which may be the
    same.
    """
    at_nodes = at_entries = fit_entries(problem, entries.reflectances, entries.rgb)
    if entry_model != problem.model:
        at_entries = fit_entries(
            replace(problem, model=entry_model), entries.reflectances, entries.rgb
        )
    return Constraints(entries.names, entry_model, at_nodes, at_entries)


def replaced(
    problem: Problem, entries: Constraints, rows: Indices, others: Constraints
) -> Constraints:
    """Return constraints of which rows (k,) have the spectra of others."""
    multipliers = others.at_nodes.multipliers
    at_nodes = with_multipliers(problem, entries.at_nodes, rows, multipliers)
    at_entries = at_nodes
    if entries.at_entries is not entries.at_nodes:
        problem = replace(problem, model=entries.entry_model)
        multipliers = others.at_entries.multipliers
        at_entries = with_multipliers(problem, entries.at_entries, rows, multipliers)
    return replace(entries, at_nodes=at_nodes, at_entries=at_entries)


def warn_of_crowded(names: Sequence[str], crowded: Sequence[int]) -> None:
    """Warn of entries whose nearest node a closer entry owns."""
    if crowded:
        problem = (
            "crowded: closer entries own the nearest node. Queries at the entries' "
            "own colours stay exact, queries near them are less accurate"
        )
        hint = (
            'use dim="auto" for a lattice that is large enough, or see the report of '
            "the cube"
        )
        listing = _listed([names[row] for row in crowded])
        warn(UpliftWarning(f"{listing} {problem}", code="entry-crowded", hint=hint))


def _listed(names: Sequence[str]) -> str:
    """'entry 'a' is', 'entries 'a', 'b', 'c' and 12 more are'."""
    shown = listed([f"'{name}'" for name in names])
    return f"entry {shown} is" if len(names) == 1 else f"entries {shown} are"


def read_libraries(
    library: Atlas | StrPath | Sequence[Atlas | StrPath],
) -> tuple[tuple[Source, Atlas], ...]:
    """Read libraries, a family per file, or spectra given as an atlas; the digest of
    these is empty.
    """
    if isinstance(library, Atlas | str | os.PathLike):
        library = [library]
    libraries = []
    for atlas in map(as_atlas, library):
        is_file = len(atlas.sources) == 1
        source = atlas.sources[0] if is_file else Source("library", "")
        libraries.append((source, atlas))
    return tuple(libraries)


def families_of(
    options: Options, libraries: Sequence[tuple[Source, Atlas]], sensor: Sensor
) -> tuple[Family, ...]:
    """Return the known families: the shipped library, then those of the user, which
    only a learnt prior may have.

    Shipped families are constant outside 380–780 nm. Warns of each library that is not
    used as measured.
    """
    if libraries and not options.learns_families:
        problem = (
            "a library shapes only the learnt prior of models with more than three "
            "coefficients"
        )
        hint = (
            'use prior="learnt" and the moments model with 4 to 17 coefficients, or '
            "leave out the library"
        )
        raise OptionError(problem, hint=hint)
    shipped = shipped_library(options.leave_out)
    if not np.array_equal(sensor.wavelengths, grid()):
        shipped = tuple(_at(family, sensor.wavelengths) for family in shipped)
    users = []
    for source, library in libraries:
        resampled = resample(library, sensor.wavelengths)
        values = resampled.values
        outside = int((~in_unit_cube(sensor.rgb(values))).sum())
        if clips := resampled.clips:
            clipped = f"{len(clips)} spectra, first '{clips[0].name}'"
            problem = f"clipped to [0, 1]: {clipped}"
            _warn_of_library(source, problem, code="entry-clipped")
        if outside:
            problem = (
                f"{outside} of {len(values)} spectra not used: their colours lie "
                f"outside {sensor.space}"
            )
            _warn_of_library(source, problem, code="entry-out-of-gamut")
        users.append(Family(source.name, values, SPREAD, RELATED))
    return (*shipped, *users)


def _warn_of_library(source: Source, problem: str, *, code: str) -> None:
    warn(UpliftWarning(f"library '{source.name}': {problem}", code=code))


def _at(family: Family, wavelengths: Array) -> Family:
    """Return a shipped family at other wavelengths."""
    rows = [np.interp(wavelengths, grid(), row) for row in family.measured]
    return replace(family, measured=np.array(rows))
