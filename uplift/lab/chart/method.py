"""Interface of methods of spectral upsampling to the chart; each is a module of `uplift.lab.chart.methods`."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Values
from uplift.lab.chart.judge import published_srgb
from uplift.lab.chart.task import Task

Result = TypeVar("Result")
Uplift = Callable[[Values, Array], Values]
"""From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N), in the method's data type."""
DTYPES = ("float64", "float32")


class NotInstalledError(Exception):
    """A package that a method needs is missing; the text names it."""


@dataclass(frozen=True)
class Claims:
    """Properties that the authors of a method claim. A method far off its claims is broken and is not drawn.

    Parameters
    ----------
    round_trip : float, optional
        Mean ΔE00 of round trips.
    min, max : float
        Range of reflectances.
    """

    round_trip: float | None = None
    min: float = 0.0
    max: float = 1.0


@dataclass(frozen=True, eq=False)
class PreparedMethod:
    """A method ready for use.

    Parameters
    ----------
    uplift : callable
        From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) in nm to reflectances (n, N).
    bytes : int
        Size of its tables.
    build_s : float or None
        CPU seconds to compute its tables, once; 0 if there are none to compute, None if they come from elsewhere.
    load_s : float
        CPU seconds to read and prepare them in a process. The first call, which may compile, is charged separately.
    """

    uplift: Uplift
    bytes: int
    build_s: float | None = 0.0
    load_s: float = 0.0


@dataclass(frozen=True)
class Method:
    """A method of spectral upsampling.

    Parameters
    ----------
    name, title : str
        Name for the command line, and name to display.
    prepare : callable
        From a `Task` to a `PreparedMethod`. Raises `NotInstalledError`.
    claims : Claims
        Claims that its answers are checked against.
    dtype : {"float64", "float32"}
        Data type of colours and reflectances.
    judge : callable
        Returns the sensor of the white and the matrix that the method states; see `uplift.lab.chart.judge`.
    batch : bool
        Whether it accepts many colours per call; otherwise ``uplift`` loops over them.
    usual, quick : bool
        Whether it is measured if no methods are named, and in a quick run.
    label : str
        Label of its marker, by default the title.
    mode : str
        Mode of lookup, which determines the shape of the marker.
    build, call : str
        Command and call that give a user of this package the same; empty for other methods.
    note : str
        Remark for the reader.
    needs : str
        Native code beyond this package and how to install it; empty if there is none. A method that needs some is
        measured in a child process, as it may crash or hang.
    """

    name: str
    title: str
    prepare: Callable[[Task], PreparedMethod]
    claims: Claims = field(default_factory=Claims)
    dtype: str = "float64"
    judge: Callable[[], Sensor] = published_srgb
    batch: bool = True
    usual: bool = True
    quick: bool = False
    label: str = ""
    mode: str = ""
    build: str = ""
    call: str = ""
    note: str = ""
    needs: str = ""


@dataclass(frozen=True)
class Family:
    """Methods with a common name, source and colour (``#rrggbb``) in the legend."""

    name: str
    source: str
    colour: str
    methods: tuple[Method, ...]


def in_both_types(method: Method, prepare: Callable[[Task, str], PreparedMethod]) -> tuple[Method, Method]:
    """Return a method in float64, and in float32 with ``-float32`` after its name.

    Parameters
    ----------
    method : Method
        The method in float64.
    prepare : callable
        From a `Task` and a data type to a `PreparedMethod`.

    Returns
    -------
    tuple of Method
        Both; the second one is not part of a quick run.
    """
    single = replace(
        method,
        name=f"{method.name}-float32",
        title=f"{method.title}, float32",
        label=f"{method.label or method.title} f32",
        prepare=lambda task: prepare(task, "float32"),
        dtype="float32",
        quick=False,
    )
    return replace(method, prepare=lambda task: prepare(task, "float64")), single


def stopwatch(function: Callable[[], Result]) -> tuple[Result, float]:
    """Call a function; return its result and the CPU seconds of all threads."""
    begin = time.process_time()
    result = function()
    return result, time.process_time() - begin


def one_by_one(spectrum: Callable[[Array], tuple[Array, Array]]) -> Uplift:
    """Extend a function of one colour to many.

    Parameters
    ----------
    spectrum : callable
        From RGB (3,) to wavelengths (M,) and values (M,). Spectra are interpolated linearly and constant outside.

    Returns
    -------
    callable
        From RGB (n, 3) and wavelengths (N,) to values (n, N).
    """

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        return np.stack([np.interp(wavelengths, *spectrum(colour)) for colour in rgb])

    return uplift


def nbytes(arrays: Mapping[str, Array] | tuple[Array, ...]) -> int:
    """Size of arrays."""
    return sum(array.nbytes for array in (arrays.values() if isinstance(arrays, Mapping) else arrays))
