"""Images as Mitsuba textures: multipliers of every texel, evaluated at the wavelengths of a ray."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.io.mitsuba.spectra import blend
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import extended_multipliers, refined_multipliers
from uplift.lookup.validation import as_colours
from uplift.models import Model, evaluate

MEAN_WAVELENGTHS = np.arange(380.0, 781.0, 25.0)
"""Wavelengths in nm of the mean reflectance, by which Mitsuba chooses between lobes; it need not be exact."""
THREADS = 2


@dataclass(frozen=True, eq=False)
class Image:
    """Multipliers (h, w, C), float32, of the texels' spectra, and their mean reflectance.

    All texels have one number of multipliers: that of the cube's entries if a texel lies in the box of an entry, else
    that of its nodes.
    """

    model: Model
    multipliers: NDArray[np.float32]
    mean: float

    @staticmethod
    def uplift(cube: Cube, rgb: Array) -> Image:
        """Uplift linear RGB (h, w, 3) to spectra of the exact colours. Raises `ColourError` outside [0, 1]."""
        data, model, function = cube.data, cube.data.model, refined_multipliers
        texels = as_colours(rgb, data.sensor)
        if data.entry_boxes.find(texels.reshape(-1, 3)).rows.size:
            model, function = data.entry_spectra.model, extended_multipliers
        refined = partial(function, data)
        multipliers = blockwise(refined, texels, model.count, dtype=np.float32, threads=THREADS)
        means = blockwise(
            lambda rows: evaluate(model, rows, MEAN_WAVELENGTHS).mean(axis=1, keepdims=True), multipliers, 1
        )
        return Image(model, multipliers, float(means.mean()))


def decode_bitmap(cube: Cube, bitmap: Any) -> Array:
    """Return linear RGB (h, w, 3) of a `mitsuba.Bitmap`. Encoded images are decoded in the cube's space."""
    import mitsuba

    rgb = bitmap.convert(pixel_format=mitsuba.Bitmap.PixelFormat.RGB)
    values = np.array(rgb)
    if values.dtype.kind == "u":
        values = values / np.iinfo(values.dtype).max
    return cube.decode(255 * values) if bitmap.srgb_gamma() else values.astype(float)


@cache
def _texture_class(variant: str) -> type:
    """Define the class for a variant, as each variant has its own base class."""
    import drjit as dr
    import mitsuba as mi

    wraps = {"repeat": dr.WrapMode.Repeat, "mirror": dr.WrapMode.Mirror, "clamp": dr.WrapMode.Clamp}

    class UpliftTexture(mi.Texture):  # type: ignore[misc]
        """Texture of spectra. Bilinear filtering blends the spectra of four texels, and thus their colours."""

        def __init__(self, props: Any, image: Image) -> None:
            super().__init__(props)
            self.image = image
            self.nearest = (
                _choice(props, "filter_type", ("bilinear", "nearest"), code="unknown-filter-type")
                == "nearest"
            )
            self.wrap = _choice(props, "wrap_mode", tuple(wraps), code="unknown-wrap-mode")
            self.to_uv = mi.Transform3f(np.array(_uv_transform(props), dtype=np.float32))
            self.texels = mi.Texture2f(
                mi.TensorXf(image.multipliers),
                filter_mode=dr.FilterMode.Nearest if self.nearest else dr.FilterMode.Linear,
                wrap_mode=wraps[self.wrap],
            )

        def eval(self, si: Any, active: Any = True) -> Any:
            """Return reflectance at the wavelengths of the surface interaction."""
            uv = self.to_uv @ si.uv
            texels, weights = self._nearest(uv, active) if self.nearest else self._bilinear(uv, active)
            return blend(self.image.model, texels, weights, si.wavelengths)

        def _nearest(self, uv: Any, active: Any) -> tuple[Any, Any]:
            return (self.texels.eval(uv, active),), (1.0,)

        def _bilinear(self, uv: Any, active: Any) -> tuple[Any, Any]:
            """Return the four surrounding texels and their weights."""
            height, width = self.image.multipliers.shape[:2]
            x, y = uv.x * width - 0.5, uv.y * height - 0.5
            x, y = x - dr.floor(x), y - dr.floor(y)
            weights = ((1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y)
            return self.texels.eval_fetch(uv, active), weights

        def mean(self) -> Any:
            """Return the mean reflectance."""
            return mi.Float(self.image.mean)

        def is_spatially_varying(self) -> bool:
            """Return True."""
            return True

        def resolution(self) -> Any:
            """Return width and height in texels."""
            height, width = self.image.multipliers.shape[:2]
            return mi.ScalarVector2i(width, height)

        def to_string(self) -> str:
            """Return a summary."""
            height, width, count = self.image.multipliers.shape
            return f"UpliftTexture[{width} × {height}, {self.image.model.name}, {count} multipliers, {self.wrap}]"

    return UpliftTexture


def texture_class() -> Any:
    """Return the texture class of the current variant."""
    import mitsuba

    return _texture_class(mitsuba.variant())


def _choice(props: Any, name: str, choices: tuple[str, ...], code: str) -> str:
    """Return a property; the first choice is the default. Raises `OptionError`."""
    chosen = str(props.get(name, choices[0]))
    if chosen not in choices:
        raise OptionError(
            f"unknown {name} '{chosen}'",
            code=code,
            hint=f"use one of {', '.join(choices)}",
        )
    return chosen


def _uv_transform(props: Any) -> Array:
    """Return the transform as (3, 3); Mitsuba also accepts (4, 4)."""
    if "to_uv" not in props:
        return np.eye(3)
    matrix = np.array(props["to_uv"].matrix, dtype=float)
    axes = [0, 1, len(matrix) - 1]
    return matrix[np.ix_(axes, axes)]
