"""Spectra and coefficients as a pure function of arrays, for programs in JAX: under
``jit``, ``vmap`` and ``grad``, on CPU or accelerator.

The interpolation is that of `uplift.lookup.bulk`. Values cannot be checked while a
function is traced: colours outside [0, 1] are clamped, NaN gives NaN.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike
from numpy.typing import ArrayLike as NumpyArrayLike
from numpy.typing import DTypeLike

from uplift.common.arrays import Array, as_array
from uplift.common.compilation import compiled
from uplift.common.errors import ColourError, OptionError, UpliftWarning, warn
from uplift.common.machine import require_xla
from uplift.common.text import pluralise
from uplift.cube.data import CubeData
from uplift.lookup.blocks import as_coefficient_count, as_float_type, as_wavelengths
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate_jax import Grid, evaluated_cells, interpolate, make_grid
from uplift.lookup.node_table import NodeTable, tabulate, tabulate_coefficients
from uplift.lookup.refine_jax import Moves, make_moves, move
from uplift.models.model import evaluate as evaluate_model

__all__ = ["TraceableCube", "evaluate", "traceable", "traceable_coefficients"]


@partial(
    jax.tree_util.register_dataclass,
    data_fields=["wavelengths", "grid", "moves"],
    meta_fields=[],
)
@dataclass(frozen=True, eq=False, repr=False)
class TraceableCube:
    """The arrays of a cube, a pytree of JAX. Made by `traceable` or
    `traceable_coefficients`.

    Two cubes of arrays of the same shapes and types share compiled code.

    Parameters
    ----------
    wavelengths : jax.Array, shape (N,), or None
        Wavelengths in nm; None of coefficients.
    grid : Grid
        Arrays of the cube; ``grid.lattice`` and ``grid.atlas`` are the values of its
        nodes and entries: spectra or coefficients.
    moves : Moves or None
        How spectra next to unrealisable colours are moved to their colours; None if
        nothing is moved. With it, columns of ``grid.lattice`` and ``grid.atlas`` from
        ``moves.first`` on are at the wavelengths of the sensor.
    """

    wavelengths: jax.Array | None
    grid: Grid
    moves: Moves | None

    def __repr__(self) -> str:
        if self.wavelengths is None:
            return "TraceableCube(coefficients)"
        # Trees of other leaves have this type, too.
        return f"TraceableCube({pluralise(np.size(self.wavelengths), 'wavelength')})"


def traceable(
    cube: Cube,
    wavelengths: NumpyArrayLike | None = None,
    *,
    dtype: DTypeLike = np.float32,
) -> TraceableCube:
    """Prepare the spectra of a cube for `evaluate`.

    The table takes 4 · dim³ · N bytes in float32, 8 in float64. That of a cube with
    unrealisable nodes has the wavelengths of the sensor, too.

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
    """
    kind = _enabled_type(dtype)
    at = as_wavelengths(wavelengths, cube.wavelengths)
    if cube.data.inexact_cells is None:
        return _on_device(tabulate(cube.data, at, kind), kind, at)
    sensor = cube.wavelengths
    columns = at if np.array_equal(at, sensor) else np.append(at, sensor)
    moves = make_moves(cube.data, at, len(columns) - len(sensor), kind)
    return _on_device(_tabulate_smoothed(cube.data, columns, kind), kind, at, moves)


def traceable_coefficients(
    cube: Cube, count: int | None = None, *, dtype: DTypeLike = np.float32
) -> TraceableCube:
    """Prepare the coefficients of a cube for `evaluate`.

    Parameters
    ----------
    cube : Cube
        The cube.
    count : int, optional
        Coefficients per spectrum, as in `Cube.coefficients`.
    dtype : dtype, default float32
        Type of colours and coefficients, as in `traceable`.

    Returns
    -------
    TraceableCube
        A pytree: an argument of `evaluate` and of functions that call it.

    Raises
    ------
    OptionError
        ``count`` or ``dtype`` is invalid, float64 is not enabled, or nodes of the cube
        are too close for float32.

    Warns
    -----
    UpliftWarning
        Nodes of a wide-gamut cube have not their own colours, so that coefficients
        around them miss theirs.
    """
    kind = _enabled_type(dtype)
    width = as_coefficient_count(count, cube.data)
    table = tabulate_coefficients(cube.data, width, kind)
    if table.exact is not None:
        warn(
            UpliftWarning(
                "coefficients of colours next to unrealisable ones miss their colours "
                "while they are traced",
                code="traced-colours-inexact",
                hint="trace spectra, or compare with Cube.coefficients",
            )
        )
    return _on_device(table, kind)


def _enabled_type(dtype: DTypeLike) -> np.dtype[Any]:
    kind = as_float_type(dtype)
    if jax.dtypes.canonicalize_dtype(kind) != kind:
        raise OptionError(
            "dtype float64 needs 64-bit types of JAX",
            hint='call jax.config.update("jax_enable_x64", True) first',
        )
    return kind


def _tabulate_smoothed(
    data: CubeData, wavelengths: Array, kind: np.dtype[Any]
) -> NodeTable:
    """Tabulate spectra of the nodes as mixtures that are moved take them."""
    table = tabulate(data, wavelengths, kind)
    rows = np.flatnonzero(data.points.distance > data.threshold)
    multipliers = data.smoothed_multipliers(rows)
    table.lattice[rows] = evaluate_model(data.model, multipliers, wavelengths)
    return table


def _on_device(
    table: NodeTable,
    kind: np.dtype[Any],
    wavelengths: Array | None = None,
    moves: Moves | None = None,
) -> TraceableCube:
    """Put the arrays of a table on the device of JAX."""
    grid = make_grid(table, kind)
    if not (np.diff(grid.nodes) > 0).all():
        raise OptionError(
            "nodes of the cube are too close for float32",
            hint="use numpy.float64",
        )
    require_xla()
    at = None if wavelengths is None else wavelengths.astype(kind)
    return TraceableCube(*jax.device_put((at, grid, moves)))


def evaluate(traced: TraceableCube, rgb: ArrayLike) -> jax.Array:
    """Compute reflectances, as mode ``spectra`` of `Cube.reflectance`, or coefficients
    in JAX.

    The function is pure and piecewise smooth: its derivatives change at the faces of
    tetrahedra and entry boxes, and in a box on the rays from its entry to its edges.
    There they are those of one side, or between both.

    Nothing is raised for values. Components of colours outside [0, 1] are clamped, and
    have no gradient; at exactly 0 and 1 it is that of the inside. A colour with NaN has
    values NaN, and so has one whose nodes a sparse cube lacks. Spectra are in [0, 1].
    They have their colours up to rounding; unrealisable colours have the spectra that
    `Cube.reflectance` gives them.

    Spectra next to unrealisable colours of wide-gamut cubes are moved to their colours,
    which takes longer than interpolation by a factor of ten or more. They are
    differentiated as implicit functions. Colours of one call are moved together, those
    of ``vmap`` all, so that images are better passed as one array.

    Parameters
    ----------
    traced : TraceableCube
        The cube. Derivatives by its arrays are those by ``grid.lattice``, the values of
        the nodes, and ``grid.atlas``, those of entries.
    rgb : array_like, shape (..., 3)
        Linear RGB; converted to the type of ``traced``.

    Returns
    -------
    jax.Array, shape (..., N) or (..., count)
        Reflectances in [0, 1], or coefficients.

    Raises
    ------
    ColourError
        The last axis of ``rgb`` does not have three components.
    """
    if not isinstance(rgb, jax.Array):
        rgb = as_array(rgb, ColourError)
    colours = jnp.asarray(rgb, traced.grid.nodes.dtype)
    if colours.shape[-1:] != (3,):
        raise ColourError(f"a colour is three numbers, got the shape {colours.shape}")
    return _evaluate(traced, colours)


@compiled
def _evaluate(traced: TraceableCube, rgb: jax.Array) -> jax.Array:
    rows = rgb.reshape(-1, 3)
    known = ~jnp.isnan(rows).any(axis=1, keepdims=True)
    # jnp.clip would halve gradients at exactly 0 and 1.
    clamped = jnp.where(rows < 0, 0, jnp.where(rows > 1, 1, rows))
    inside = jnp.where(known, clamped, 0)
    values = interpolate(traced.grid, inside)
    if traced.wavelengths is not None:
        # Rounding alone leaves [0, 1]: gradients are those of the mixture.
        values += jax.lax.stop_gradient(jnp.clip(values, 0, 1) - values)
    values = jnp.where(known, values, jnp.nan)
    if traced.moves is not None:
        cells = evaluated_cells(traced.grid, inside)
        values = move(traced.moves, values, inside, cells)
    return values.reshape(*rgb.shape[:-1], values.shape[1])
