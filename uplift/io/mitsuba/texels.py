"""Texels of an image: the numbers of their spectra, uplifted from RGB, and how they lie on a surface."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.common.errors import unknown_name
from uplift.io.texture.colours import Counts, Floats
from uplift.io.texture.uplifter import Multipliers, Uplifter, prepare
from uplift.lights.lookup import EmissionTable
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.models import evaluate
from uplift.models.model import Model

MEAN_WAVELENGTHS = np.arange(380.0, 781.0, 25.0)
"""Wavelengths in nm of the mean reflectance, by which Mitsuba chooses between lobes; it need not be exact."""
THREADS = 2
PADDING = 1
"""Texels around the padded image, which repeat those of the other edge or of the same, as the mode beyond requires."""
FILTERS = ("bilinear", "nearest", "stochastic")
WRAPS = {"repeat": "wrap", "mirror": "symmetric", "clamp": "edge"}
"""Modes beyond the edges, and the modes of `numpy.pad` for them."""


@dataclass(frozen=True)
class Samples:
    """Reflectances, or powers of lights, at ``count`` equidistant wavelengths from ``start`` to ``end`` nm.

    Between them spectra are straight lines, outside they are constant.
    """

    start: float
    end: float
    count: int
    name = "samples"


@dataclass(frozen=True, eq=False)
class Texels:
    """Numbers (h, w, C), float32, of the texels' spectra, and the mean reflectance.

    The numbers are the multipliers of a model, or reflectances or powers if ``model`` is `Samples`.
    """

    model: Model | Samples
    numbers: NDArray[np.float32]
    mean: float

    def describe(self, wrap: str) -> str:
        """Return a summary for Mitsuba, with the mode beyond the edges."""
        height, width, count = self.numbers.shape
        numbers = "samples" if isinstance(self.model, Samples) else "multipliers"
        return f"UpliftTexture[{width} × {height}, {self.model.name}, {count} {numbers}, {wrap}]"


def prepare_texels(cube: Cube, method: str, *, of_entries: bool = False) -> Uplifter:
    """Prepare a cube for texels, with as many multipliers as its nodes or ``of_entries`` have."""
    return prepare(cube, Multipliers(of_entries), out_of_gamut=method, threads=THREADS)


def uplift_texels(uplifter: Uplifter, rgb: Floats) -> tuple[Texels, Counts]:
    """Uplift linear RGB (h, w, 3) of its decoder to multipliers of spectra that have exactly these colours.

    All texels have one number of multipliers: that of the cube's entries if a texel lies in the box of an entry, else
    that of its nodes.
    """
    data, colours = uplifter.cube.data, rgb.reshape(-1, 3).astype(float)
    if any(found.rows.size for found in (data.entry_boxes.find(colours.clip(0, 1)), data.outside_boxes.find(colours))):
        uplifter = prepare_texels(uplifter.cube, uplifter.out_of_gamut, of_entries=True)
    assert uplifter.model is not None
    (_, multipliers), counts = uplifter.convert(rgb)
    return model_texels(uplifter.model, multipliers), counts


def model_texels(model: Model, multipliers: NDArray[Any]) -> Texels:
    """Return texels of multipliers (h, w, C)."""
    means = blockwise(lambda rows: evaluate(model, rows, MEAN_WAVELENGTHS).mean(axis=1, keepdims=True), multipliers, 1)
    return Texels(model, multipliers, float(means.mean()))


def light_texels(table: EmissionTable, rgb: Array) -> Texels:
    """Uplift linear RGB (h, w, 3) of lights to power at the wavelengths of the table.

    Colours that no light has are moved towards white. Raises `ColourError` for values that are not finite.
    """
    at = table.wavelengths
    power = table.spectrum(rgb, outside="clip", dtype=np.float32, threads=THREADS)
    return Texels(Samples(float(at[0]), float(at[-1]), len(at)), power, float(power.mean(dtype=float)))


@dataclass(frozen=True, eq=False)
class Placement:
    """How texels lie on a surface: filter, mode beyond the edges, and transform (3, 3) of the coordinates."""

    filter: str
    wrap: str
    to_uv: Array

    @staticmethod
    def read(props: Any) -> "Placement":
        """Read the properties ``filter_type``, ``wrap_mode`` and ``to_uv``. Raises `UnknownNameError`."""
        chosen = _choice(props, "filter_type", FILTERS), _choice(props, "wrap_mode", tuple(WRAPS))
        return Placement(*chosen, _uv_transform(props))

    def pad(self, numbers: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return numbers (h, w, C) with `PADDING` texels around them, so that no lookup needs to wrap."""
        return np.pad(numbers, ((PADDING, PADDING), (PADDING, PADDING), (0, 0)), WRAPS[self.wrap])  # type: ignore[call-overload]


def _choice(props: Any, name: str, choices: tuple[str, ...]) -> str:
    """Return a property; the first choice is the default."""
    chosen = str(props.get(name, choices[0]))
    if chosen not in choices:
        raise unknown_name(chosen, choices, name)
    return chosen


def _uv_transform(props: Any) -> Array:
    """Return the transform as (3, 3); Mitsuba also accepts (4, 4)."""
    if "to_uv" not in props:
        return np.eye(3)
    matrix = np.array(props["to_uv"].matrix, dtype=float)
    axes = [0, 1, len(matrix) - 1]
    return matrix[np.ix_(axes, axes)]
