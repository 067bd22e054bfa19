"""What a method of spectral upsampling is to the chart: one is a file of `uplift.lab.chart.methods`."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.task import Task

Made = TypeVar("Made")
Uplift = Callable[[Array, Array], Array]
"""From linear sRGB (n, 3) in [0, 1] and wavelengths (N,) nm to reflectances (n, N)."""


class NotInstalledError(Exception):
    """What a method needs is not here; the text says what."""


@dataclass(frozen=True)
class Claims:
    """What a method's makers say of its answers. One that is far off is broken, and not drawn.

    ``round_trip`` is a mean ΔE00, None where nothing is claimed; reflectances are to lie from ``least`` to ``most``.
    """

    round_trip: float | None = None
    least: float = 0.0
    most: float = 1.0


@dataclass(frozen=True, eq=False)
class PreparedMethod:
    """A method ready to be asked: what it holds in bytes, and the CPU seconds that making that took.

    ``seconds`` is 0 where there is nothing to make, None where it was made elsewhere.
    """

    uplift: Uplift
    bytes: int
    seconds: float | None = 0.0


@dataclass(frozen=True)
class Method:
    """One way from RGB to spectra.

    Parameters
    ----------
    name, title : for the command line, and for people.
    prepare : makes it ready. Raises `NotInstalledError`.
    claims : what its answers are held to.
    batch : whether it takes many colours at once; if not, ``uplift`` loops over them.
    usual, quick : whether it is measured where no methods are named, and in a quick run.
    label, mode : what stands beside its marker, by default the title, and the mode that gives the marker its shape.
    build, ask : the command and the call that give a user of this package the same; empty for others.
    note : what a reader must know.
    """

    name: str
    title: str
    prepare: Callable[[Task], PreparedMethod]
    claims: Claims = field(default_factory=Claims)
    batch: bool = True
    usual: bool = True
    quick: bool = False
    label: str = ""
    mode: str = ""
    build: str = ""
    ask: str = ""
    note: str = ""


@dataclass(frozen=True)
class Family:
    """Methods that share a name and a colour (``#rrggbb``) in the legend, and the source they are from."""

    name: str
    source: str
    colour: str
    methods: tuple[Method, ...]


def stopwatch(make: Callable[[], Made]) -> tuple[Made, float]:
    """What ``make`` makes, and CPU seconds of all threads."""
    begin = time.process_time()
    made = make()
    return made, time.process_time() - begin


def one_by_one(spectrum: Callable[[Array], tuple[Array, Array]]) -> Uplift:
    """From a function of one colour (3,), that gives wavelengths (M,) and values (M,), to many.

    Between its wavelengths a spectrum is interpolated linearly; outside it is held flat.
    """

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        return np.stack([np.interp(wavelengths, *spectrum(colour)) for colour in rgb])

    return uplift


def nbytes(arrays: Mapping[str, Array] | tuple[Array, ...]) -> int:
    """Bytes of arrays."""
    return sum(array.nbytes for array in (arrays.values() if isinstance(arrays, Mapping) else arrays))
