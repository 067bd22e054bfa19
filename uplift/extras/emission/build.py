"""The order of the build of an emission table: lamps → prior → nodes → table."""

import os
from collections.abc import Collection, Sequence
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from uplift.atlas.atlas import Atlas, Source
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer as observers
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OptionError, UpliftWarning, warn
from uplift.common.machine import single_threaded_blas
from uplift.common.text import listed, pluralise
from uplift.common.version import version
from uplift.extras.colour.light_sets import STANDARD_ILLUMINANTS
from uplift.extras.colour.spaces import look_up_space, primaries_of
from uplift.extras.emission.discs import Lamps, lamp_entries
from uplift.extras.emission.file import EmissionData
from uplift.extras.emission.fit import locus_lattice, mix_with_locus, nearest_lights
from uplift.extras.emission.lamps import SAME_LAMP, known_lamps, read_lamps
from uplift.extras.emission.lattice import ChromaticityLattice, chromaticity
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.emission.prior import (
    LampKernel,
    LampPrior,
    fit_lamp_prior,
    relit_delta_e,
)
from uplift.lookup.blocks import as_whole_number

ERROR_LENGTH = 0.02
"""Distance in u′v′ over which errors of left-out lamps are averaged."""
FAR_SHARE = 1e-2
"""Weight of the mean error of all lamps, which far from them is the expected one."""
MAX_NODES = 1024
SURFACES = "macbeth"
"""Atlas of the surfaces by which predictions of lamps are judged."""

LampFiles = Atlas | StrPath | Sequence[StrPath] | None


@single_threaded_blas()
def build_emission(
    atlas: LampFiles = None,
    *,
    knots: int = 96,
    rings: int = 24,
    space: str = "sRGB",
    observer: str = observers.DEFAULT_OBSERVER,
    without: Collection[str] = (),
) -> EmissionTable:
    """Build a table of the spectra of lights, constrained by measured lamps.

    Lights scale, so the table is a lattice over chromaticity, up to the spectral locus.
    Lamps are exact at their chromaticities. Between them, spectra are those expected by
    the lamps around, and smooth where no lamp is near.

    Parameters
    ----------
    atlas : Atlas, path-like or sequence of path-like, optional
        Measured lamps, or the files that contain them, in addition to those of
        colour-science. Of lamps of nearly the same chromaticity, those of the atlas are
        exact; without an atlas, the CIE illuminants A and D50 to D75.
    knots : int, default 96
        Nodes around white, 3 to 1024. The spectral locus has one at each corner, so
        there are never fewer than these.
    rings : int, default 24
        Nodes from white to the locus, 3 to 1024.
    space : str, default "sRGB"
        RGB space of queries, by its name in colour-science. White is the white of the
        space, without adaptation.
    observer : str, default "CIE 1931 2 Degree Standard Observer"
        Colour-matching functions.
    without : collection of str, optional
        Names of lamps of colour-science to leave out, to test how lamps are predicted
        that the table does not know.

    Returns
    -------
    EmissionTable
        The table, ready for queries; `EmissionTable.save` writes it.

    Raises
    ------
    AtlasError
        A file of lamps that cannot be read.
    OptionError
        An option outside its range.
    UnknownNameError
        An unknown space, observer or lamp.

    Warns
    -----
    UpliftWarning
        Lamps of the atlas with the chromaticity of another one of it, which are left
        out (``entry-duplicate``), or entries of a file that were skipped
        (``entry-skipped``).

    Examples
    --------
    >>> import uplift
    >>> table = uplift.build_emission(knots=64, rings=4)
    >>> table.rgb(table.spectrum([3.0, 0.2, 0.1])).round(6).tolist()
    [3.0, 0.2, 0.1]
    """
    knots = as_whole_number(knots, "knots", 3)
    rings = as_whole_number(rings, "rings", 3)
    if max(knots, rings) > MAX_NODES:
        raise OptionError(
            f"knots and rings must each be a whole number from 3 to {MAX_NODES}, got "
            f"{knots} and {rings}"
        )
    observers.require_observer(observer, "emission tables")
    sensor = observers.sensor(space, "D65", observer)
    radiometry = sensor.cmfs / sensor.cmfs[:, 1].sum()
    matrix = primaries_of(look_up_space(space)).rgb_to_xyz
    white = chromaticity(matrix.sum(axis=1))
    known = known_lamps(observer).without(without)
    exact, others, sources = _choose_lamps(atlas, known, sensor.wavelengths, radiometry)
    lamps = np.concatenate([exact.power, others.power])
    surfaces = on_grid(read_atlas(SURFACES), observers.grid())

    prior, left_out = fit_lamp_prior(lamps, surfaces, radiometry, len(exact))
    lattice, locus = locus_lattice(radiometry, white, knots, np.linspace(0, 1, rings))
    uv = lattice.nodes[:, :-1].reshape(-1, 2)
    inner = mix_with_locus(
        nearest_lights(prior(uv), uv, radiometry), uv, lattice, locus, radiometry
    )
    nodes = np.concatenate(
        [inner.reshape(len(locus), -1, inner.shape[1]), locus[:, None]], axis=1
    )
    left_out_errors = relit_delta_e(lamps, left_out, surfaces, radiometry).mean(axis=1)

    entries, duplicates = lamp_entries(exact, others, lattice, radiometry)
    _warn_of_duplicates(duplicates)
    options = {"knots": knots, "rings": rings, "without": sorted(without)}
    data = EmissionData(
        space=sensor.space,
        observer=sensor.observer,
        rgb_to_xyz=matrix,
        wavelengths=sensor.wavelengths,
        cmfs=sensor.cmfs,
        lattice=lattice,
        spectra=nodes.astype(np.float32),
        error=_expected_error(left_out_errors, prior, lattice),
        entries=entries,
        provenance={
            "uplift": version(),
            "options": options,
            "atlases": [_record(source) for source in sources],
            "left_out": [name for name, _ in duplicates],
            "prior": asdict(prior.kernel),
        },
    )
    return EmissionTable(data)


def _warn_of_duplicates(duplicates: Sequence[tuple[str, str]]) -> None:
    """Warn of lamps that have the chromaticity of another, the second of each pair."""
    if not duplicates:
        return
    pairs = listed([f"'{name}' that of '{other}'" for name, other in duplicates])
    omitted = pluralise(len(duplicates), "lamp")
    problem = f"{omitted} left out, with the chromaticity of an earlier one: {pairs}"
    warn(UpliftWarning(problem, code="entry-duplicate"))


def _choose_lamps(
    atlas: LampFiles, known: Lamps, wavelengths: Array, radiometry: Array
) -> tuple[Lamps, Lamps, tuple[Source, ...]]:
    """Return lamps that must be exact, other known ones, and the files of the former.

    The exact ones are those of the atlas at luminance 1, by default standard
    illuminants. None of the others has the name or spectrum of an exact one.
    """
    if atlas is None:
        is_standard = np.isin(known.names, STANDARD_ILLUMINANTS)
        return known.only(is_standard), known.only(~is_standard), ()
    if not isinstance(atlas, Atlas):
        atlas = read_lamps(
            *([atlas] if isinstance(atlas, str | os.PathLike) else atlas)
        )
    if not len(atlas):
        raise OptionError("an atlas of lamps must have lamps, got none")
    power = on_grid(atlas, wavelengths)
    luminance = power @ radiometry[:, 1]
    if not (luminance > 0).all():
        dark = atlas.names[int(luminance.argmin())]
        raise OptionError(f"a lamp must have visible power, got none of '{dark}'")
    exact = Lamps(atlas.names, power / luminance[:, None])
    is_other = [
        name not in exact.names
        and np.abs(exact.power - row).max(axis=1).min() > SAME_LAMP * row.max()
        for name, row in zip(known.names, known.power, strict=True)
    ]
    return exact, known.only(np.array(is_other)), atlas.sources


def _expected_error(
    errors: Array, prior: LampPrior, lattice: ChromaticityLattice
) -> NDArray[np.float32]:
    """ΔE00 (K, R) of the ColorChecker lit by an answer.

    Errors (L,) of left-out lamps, in units of the standard deviation of the prior
    there, are averaged by distance.
    """
    units = errors / prior.left_out_deviation()
    uv = lattice.nodes.reshape(-1, 2)
    weights = LampKernel(ERROR_LENGTH, 0.0)(uv, prior.uv)
    unit = (weights @ units + FAR_SHARE * units.mean()) / (
        weights.sum(axis=1) + FAR_SHARE
    )
    return np.asarray(
        (unit * prior.standard_deviation(uv)).reshape(lattice.shape), dtype=np.float32
    )


def _record(source: Source) -> dict[str, str]:
    """Name and digest of a file of lamps, and the scale of its values if the caller
    gave it.
    """
    scale = {} if source.measured == "auto" else {"measured": source.measured}
    return {"name": source.name, "digest": source.digest, **scale}
