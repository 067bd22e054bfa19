"""The cube: linear RGB in, coefficients and reflectance spectra out. Needs
numpy only.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.illuminants import Illuminant
from uplift.common.arrays import Array, Mask, as_array
from uplift.common.errors import ColourError, unknown_name
from uplift.cube.data import CubeData
from uplift.cube.file import read, write
from uplift.lookup import blocks
from uplift.lookup.interpolate import (
    MODES,
    coefficients,
    extended_coefficients,
    node_errors,
)

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Light

FOLDER = Path(__file__).parent
DEFAULT = FOLDER / "default.uplift"
"""The cube of sRGB."""
PACKAGED = {"srgb": DEFAULT, "acescg": FOLDER / "acescg.uplift"}
"""Cubes of the package by the name of their space in lower case. They have D65 and no
atlas.
"""
MAX_TABLE_BYTES = 1 << 28
"""Largest table of the spectra of all nodes that a query computes."""
TABULATED = ("spectra", "nearest")
"""Modes that can use a table, which are methods of
`uplift.lookup.node_table.NodeTable`.
"""


@dataclass(frozen=True, eq=False, repr=False)
class Cube:
    """A spectral uplifting cube.

    Its methods raise `ColourError` for colours outside [0, 1], not finite, or not in
    the scene of a sparse cube, `UnknownNameError` for an unknown mode or light, and
    `OptionError` for other invalid arguments. Results do not depend on the number of
    threads.

    Parameters
    ----------
    data : CubeData
        Content of a cube file.

    Examples
    --------
    >>> import uplift
    >>> uplift.load()
    Cube(moments with 9 coefficients, dim 16, sRGB under D65, 0 entries)
    """

    data: CubeData

    def __repr__(self) -> str:
        return f"Cube{repr(self.data).removeprefix('CubeData')}"

    @property
    def dim(self) -> int:
        """Nodes along each axis."""
        return self.data.lattice.dim

    @property
    def space(self) -> str:
        """RGB space of queries."""
        return self.data.sensor.space

    @property
    def illuminant(self) -> str:
        """Illuminant under which reflectances have their RGB."""
        return self.data.sensor.illuminant

    @property
    def observer(self) -> str:
        """Colour-matching functions."""
        return self.data.sensor.observer

    @property
    def wavelengths(self) -> Array:
        """(N,) wavelengths of the sensor in nm, the default of queries."""
        return self.data.sensor.wavelengths

    @property
    def coefficient_count(self) -> int:
        """Coefficients per spectrum of a node."""
        return self.data.model.count

    @property
    def entry_coefficient_count(self) -> int:
        """Coefficients per spectrum of an atlas entry: as many as a node
        has, or more.
        """
        return self.data.atlas.spectra.model.count

    @property
    def atlas_names(self) -> tuple[str, ...]:
        """Names of the atlas entries that constrain the cube."""
        return self.data.atlas.names

    @property
    def outside_names(self) -> tuple[str, ...]:
        """Names of the atlas entries outside the RGB space, which XYZ and textures of
        wider spaces get.
        """
        return () if self.data.atlas.outside is None else self.data.atlas.outside.names

    def coefficients(
        self,
        rgb: ArrayLike,
        count: int | None = None,
        *,
        dtype: DTypeLike = np.float64,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Interpolate the coefficients of the model between nodes and atlas entries.

        With the ``count`` of the lattice the entries have their exact colours, and
        spectra fitted with as few coefficients. With that of the entries they have
        their spectra, and those of the lattice do not change.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1].
        count : int, optional
            `coefficient_count`, the default, or `entry_coefficient_count`.
        dtype : {float64, float32}, default float64
            Type of the result.
        threads : int, default 1
            Number of threads.

        Returns
        -------
        ndarray, shape (..., count)
            Coefficients.
        """
        width = blocks.as_coefficient_count(count, self.data)
        colours = blocks.as_colours(rgb, self.data.sensor)
        kind = blocks.as_float_type(dtype)
        threads = blocks.as_thread_count(threads)
        function: blocks.Function = partial(coefficients, self.data)
        if width != self.coefficient_count:
            function = partial(extended_coefficients, self.data)
            if self._is_table_worthwhile(colours, width * kind.itemsize):
                from uplift.lookup.node_table import tabulate_coefficients

                function = tabulate_coefficients(self.data, width, kind, threads).values
        return blocks.blockwise(function, colours, width, kind, threads)

    def reflectance(
        self,
        rgb: ArrayLike,
        wavelengths: ArrayLike | None = None,
        mode: str = "spectra",
        *,
        dtype: DTypeLike = np.float64,
        threads: int = 1,
    ) -> NDArray[Any]:
        """Compute reflectance spectra whose colour, under the illuminant of the cube,
        is the given RGB.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1], in the RGB space of the cube.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm from 100 to 5000, by default those of the sensor. Spectra
            are constant outside the range of the model.
        mode : {"spectra", "moments", "refined", "nearest"}, default "spectra"
            ``"spectra"`` interpolates spectra, with exact colours. ``"moments"``
            interpolates coefficients, with nearly exact colours. ``"refined"`` moves
            those to the exact colour. ``"nearest"`` is the spectrum of the nearest
            node, of another colour.
        dtype : {float64, float32}, default float64
            Type of the result; float32 differs by less than 1e-6.
        threads : int, default 1
            Number of threads.

        Returns
        -------
        ndarray, shape (..., N)
            Reflectances in [0, 1].

        Examples
        --------
        >>> import uplift
        >>> spectra = uplift.load().reflectance([[1, 1, 1], [0, 0, 0]], [500, 600])
        >>> spectra.round(3).tolist()
        [[1.0, 1.0], [0.0, 0.0]]
        """
        colours = blocks.as_colours(rgb, self.data.sensor)
        if mode not in MODES:
            raise unknown_name(str(mode), MODES, "mode")
        at = blocks.as_wavelengths(wavelengths, self.data.sensor.wavelengths)
        kind = blocks.as_float_type(dtype)
        count = blocks.as_thread_count(threads)
        function: blocks.Function = partial(MODES[mode], self.data, wavelengths=at)
        row_bytes = len(at) * kind.itemsize
        if mode in TABULATED and self._is_table_worthwhile(colours, row_bytes):
            from uplift.lookup.node_table import tabulate

            function = getattr(tabulate(self.data, at, kind, count), mode)
        return blocks.blockwise(function, colours, len(at), kind, count)

    def _is_table_worthwhile(self, colours: Array, row_bytes: int) -> bool:
        """Whether to compute the spectra of all nodes once, instead of repeatedly per
        block.
        """
        present = self.data.points.present
        fits = present.size * row_bytes <= MAX_TABLE_BYTES
        return fits and bool(colours.size // 3 >= np.count_nonzero(present))

    def covers(self, rgb: ArrayLike) -> Mask:
        """Test whether the cube can answer colours in [0, 1]: all of them, unless it
        was built for a scene.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1].

        Returns
        -------
        ndarray of bool, shape (...)
            True where it can.
        """
        colours = blocks.as_colours(rgb, self.data.sensor)
        if not self.data.is_sparse:
            return np.ones(colours.shape[:-1], dtype=bool)
        points = self.data.entry_boxes.nodes(colours.reshape(-1, 3)).points
        return self.data.points.holds(points).reshape(colours.shape[:-1])

    def fill_missing(
        self,
        rgb: ArrayLike | None = None,
        other: Cube | None = None,
        *,
        threads: int = 1,
    ) -> Cube:
        """Add missing nodes of a sparse cube: spectra of its model, fitted to those of
        another, with exact colours.

        Parameters
        ----------
        rgb : array_like, shape (..., 3), optional
            Colours that the result must answer; all by default.
        other : Cube, optional
            Cube of the same RGB space, illuminant and observer; the default cube of the
            package by default.
        threads : int, default 1
            Number of threads.

        Returns
        -------
        Cube
            The filled cube; this cube if no node is missing.
        """
        from uplift.lookup.missing_nodes import fill_missing

        colours = None
        if rgb is not None:
            colours = blocks.as_colours(rgb, self.data.sensor).reshape(-1, 3)
        points = self.data.missing_points(colours)
        if not points.size:
            return self
        source = (load() if other is None else other).data
        count = blocks.as_thread_count(threads)
        return Cube(fill_missing(self.data, points, source, count))

    def standard_error(
        self, rgb: ArrayLike, light: Illuminant | Light | None = None
    ) -> Array | None:
        """Estimate the difference that 68 % of measurements stay within, as learnt from
        left-out atlas entries.

        It holds for materials like those of the atlas, which colours alone do not
        identify; see `unlike_atlas`. Cubes with fewer than 8 entries learn it from
        families of materials that are left out, for materials of unknown families.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1].
        light : str, Lamp or Light, optional
            Illuminant, by its name in colour-science, or measured.
            ``data.error_illuminant`` by default; others need a cube with left-out
            materials, or raise `OptionError`.

        Returns
        -------
        ndarray, shape (...), or None
            ΔE00; None if the cube has no left-out materials.
        """
        errors = expected_errors(self, rgb, light)
        return None if errors is None else errors[..., 0]

    def error_bound(
        self, rgb: ArrayLike, light: Illuminant | Light | None = None
    ) -> Array | None:
        """Estimate the difference that 95 % of measurements stay within, which is
        learnt separately.

        Parameters
        ----------
        rgb, light
            As in `standard_error`.

        Returns
        -------
        ndarray, shape (...), or None
            ΔE00.
        """
        errors = expected_errors(self, rgb, light)
        return None if errors is None else errors[..., 1]

    def unlike_atlas(self, rgb: ArrayLike) -> Mask:
        """Find colours that are far from all materials that standard errors are learnt
        from: the atlas entries, or families where these are too few.

        It is a statement on colours: standard errors are extrapolated there. It does
        not find materials on which the cube errs. Those are of another kind than the
        entries, and nearly all have colours like theirs.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1].

        Returns
        -------
        ndarray of bool, shape (...)
            True for colours farther from every material, in CIE L*a*b*, than 95 % of
            the materials are from another one.
        """
        from uplift.colorimetry.likely_errors import nearest_distances

        data = self.data
        lab = rgb_to_lab(data.sensor, blocks.as_colours(rgb, data.sensor))
        distances = nearest_distances(lab.reshape(-1, 3), data.evidence_lab)
        return (distances > data.familiar_distance).reshape(lab.shape[:-1])

    def decode(self, codes: ArrayLike) -> Array:
        """Convert 8-bit codes to linear RGB, by the encoding of the RGB space.

        Parameters
        ----------
        codes : array_like, shape (...)
            Codes from 0 to 255; fractions are interpolated.

        Returns
        -------
        ndarray, shape (...)
            Linear RGB.
        """
        return blocks.decode_codes(self.data.sensor, codes)

    def encode(self, rgb: ArrayLike) -> Array:
        """Convert linear RGB to 8-bit codes, the inverse of `decode`.

        Parameters
        ----------
        rgb : array_like, shape (...)
            Linear RGB in [0, 1].

        Returns
        -------
        ndarray, shape (...)
            Codes from 0 to 255, with fractions.
        """
        linear = as_array(rgb, ColourError)
        return np.interp(linear, self.data.sensor.decoding, np.arange(256))

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the cube file, atomically.

        Parameters
        ----------
        path : path-like
            File to write.
        force : bool, default False
            Replace an existing file.
        """
        write(self.data, path, force=force)


def load(path: str | os.PathLike[str] | None = None) -> Cube:
    """Load a cube.

    Parameters
    ----------
    path : path-like, optional
        Cube file, or ``"srgb"`` or ``"acescg"`` if no file has the name. By default the
        sRGB cube of the package. The packaged cubes have D65 and no atlas.

    Returns
    -------
    Cube
        The cube.

    Raises
    ------
    CubeFileError
        The file is missing, damaged, not a cube file, or of a version that this one
        does not read.
    """
    return Cube(read(DEFAULT if path is None else find_file(path)))


def expected_errors(
    cube: Cube, rgb: ArrayLike, light: Illuminant | Light | None = None
) -> Array | None:
    """Standard errors and error bounds (…, 2) of a cube that has estimates. Those of
    nodes are under one light.
    """
    data = cube.data
    if data.points.standard_error is None:
        return None
    from uplift.lookup.errors_under_lights import as_light, light_errors, limited

    lit = data.error_illuminant if light is None else as_light(data, light)
    if isinstance(lit, str) or lit.name == data.error_illuminant:

        def function(rgb: Array) -> Array:
            return limited(data, lit, rgb, node_errors(data, rgb))

    else:
        function = light_errors(data, lit)
    return blocks.blockwise(function, blocks.as_colours(rgb, data.sensor), 2)


def find_file(
    path: str | os.PathLike[str], packaged: dict[str, Path] = PACKAGED
) -> str | os.PathLike[str]:
    """Return the packaged file that a name, in any case, stands for, or else the path.
    A file takes precedence.
    """
    file = packaged.get(os.fsdecode(path).casefold())
    return path if file is None or os.path.lexists(path) else file
