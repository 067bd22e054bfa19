"""Spectra as a pure function of arrays, for programs in JAX: under ``jit``, ``vmap``
and ``grad``, on CPU or accelerator.

The interpolation is that of `uplift.lookup.bulk`. Values cannot be checked while a
function is traced: colours outside [0, 1] are clamped, NaN gives NaN.
"""

from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike
from numpy.typing import ArrayLike as NumpyArrayLike
from numpy.typing import DTypeLike

from uplift.common.errors import ColourError, OptionError, UpliftWarning, warn
from uplift.common.machine import require_memory_of_xla
from uplift.common.text import pluralise
from uplift.lookup.blocks import as_float_type, as_wavelengths
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate_jax import Grid, evaluated_cells, interpolate, make_grid
from uplift.lookup.node_table import tabulate
from uplift.lookup.refine_jax import Moves, make_moves, move
from uplift.models import evaluate as evaluate_model

__all__ = ["TraceableCube", "evaluate", "traceable"]


@partial(
    jax.tree_util.register_dataclass,
    data_fields=["wavelengths", "grid", "moves"],
    meta_fields=[],
)
@dataclass(frozen=True, eq=False, repr=False)
class TraceableCube:
    """The arrays of a cube, a pytree of JAX. Made by `traceable`.

    Two cubes of arrays of the same shapes and types share compiled code.

    Parameters
    ----------
    wavelengths : jax.Array, shape (N,)
        Wavelengths in nm.
    grid : Grid
        Arrays of the cube; ``grid.lattice`` and ``grid.atlas`` are the spectra of its
        nodes and entries.
    """

    wavelengths: jax.Array
    grid: Grid
    moves: Moves | None

    def __repr__(self) -> str:
        # Trees of other leaves have this type, too.
        return f"TraceableCube({pluralise(np.size(self.wavelengths), 'wavelength')})"


def traceable(
    cube: Cube,
    wavelengths: NumpyArrayLike | None = None,
    *,
    dtype: DTypeLike = np.float32,
) -> TraceableCube:
    """Prepare a cube for `evaluate`.

    The table takes 4 · dim³ · N bytes in float32, 8 in float64.

    Parameters
    ----------
    cube : Cube
        The cube.
    wavelengths : array_like, shape (N,), optional
        Wavelengths in nm, by default those of the sensor.
    dtype : dtype, default float32
        Type of colours and spectra: float32, or float64 if 64-bit types of JAX are
        enabled.

    Returns
    -------
    TraceableCube
        A pytree: an argument of `evaluate` and of functions that call it.

    Raises
    ------
    OptionError
        ``wavelengths`` or ``dtype`` is invalid, float64 is not enabled, or nodes of the
        cube are too close for float32.

    Warns
    -----
    UpliftWarning
        Nodes of a wide-gamut cube have not their own colours, so that spectra around
        them miss theirs.
    """
    kind = as_float_type(dtype)
    if jax.dtypes.canonicalize_dtype(kind) != kind:
        raise OptionError(
            "dtype float64 needs 64-bit types of JAX",
            hint='call jax.config.update("jax_enable_x64", True) first',
        )
    at = as_wavelengths(wavelengths, cube.wavelengths)
    data = cube.data
    cells = data.inexact_cells
    columns = at
    moves = None
    if cells is not None:
        sensor = data.sensor.wavelengths
        if not np.array_equal(at, sensor):
            columns = np.append(at, sensor)
        moves = make_moves(data, cells, at, len(columns) - len(sensor), kind)
    table = tabulate(data, columns, kind)
    if cells is not None:
        rows = np.flatnonzero(data.points.distance > data.threshold)
        table.lattice[rows] = evaluate_model(data.model, data.smoothed_multipliers(rows), columns)
    grid = make_grid(table, kind)
    if not (np.diff(grid.nodes) > 0).all():
        raise OptionError(
            "nodes of the cube are too close for float32",
            hint="use numpy.float64",
        )
    require_memory_of_xla()
    return TraceableCube(*jax.device_put((at.astype(kind), grid, moves)))


def evaluate(traced: TraceableCube, rgb: ArrayLike) -> jax.Array:
    """Compute reflectances, as mode ``spectra`` of `Cube.reflectance`, in JAX.

    The function is pure and piecewise smooth: its derivatives change at the faces of
    cells and entry boxes, and in a box on the rays from its entry to its edges. There
    they are those of one side, or between both.

    Nothing is raised for values. Components of colours outside [0, 1] are clamped, and
    have no gradient; at exactly 0 and 1 it is that of the inside. A colour with NaN has
    the spectrum NaN, and so has one whose nodes a sparse cube lacks. Spectra are in [0,
    1]. They have their colours up to rounding, except around nodes of wide-gamut cubes
    that have not: there `Cube.reflectance` takes a further step, and this function does
    not.

    Parameters
    ----------
    traced : TraceableCube
        The cube. Derivatives by its arrays are those by ``grid.lattice``, the spectra
        of the nodes, and ``grid.atlas``, those of entries.
    rgb : array_like, shape (..., 3)
        Linear RGB; converted to the type of ``traced``.

    Returns
    -------
    jax.Array, shape (..., N)
        Reflectances in [0, 1].

    Raises
    ------
    ColourError
        The last axis of ``rgb`` does not have three components.
    """
    try:
        colours = jnp.asarray(rgb, traced.grid.nodes.dtype)
    except (TypeError, ValueError) as error:
        raise ColourError(f"a colour is three numbers, got {rgb!r}") from error
    if colours.shape[-1:] != (3,):
        raise ColourError(f"a colour is three numbers, got the shape {colours.shape}")
    return _evaluate(traced, colours)


@jax.jit
def _evaluate(traced: TraceableCube, rgb: jax.Array) -> jax.Array:
    grid, moves = traced.grid, traced.moves
    rows = rgb.reshape(-1, 3)
    known = ~jnp.isnan(rows).any(axis=1)
    # jnp.clip would halve gradients at exactly 0 and 1.
    clamped = jnp.where(rows < 0, 0, jnp.where(rows > 1, 1, rows))
    inside = jnp.where(known[:, None], clamped, 0)
    mixed = interpolate(grid, inside)
    # Rounding alone leaves [0, 1]: gradients are those of the mixture.
    spectra = mixed + jax.lax.stop_gradient(jnp.clip(mixed, 0, 1) - mixed)
    if moves is not None:
        inexact = moves.cells[evaluated_cells(grid, inside)] & known
        spectra = move(moves, spectra, inside, inexact & ~jnp.isnan(mixed[:, 0]))
    spectra = jnp.where(known[:, None], spectra, jnp.nan)
    return spectra.reshape(*rgb.shape[:-1], spectra.shape[1])
