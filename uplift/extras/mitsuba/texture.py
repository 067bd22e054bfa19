"""Texture and environment of Mitsuba, whose spectra Dr.Jit evaluates at the wavelengths
of a ray.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from uplift.extras.mitsuba.texels import PADDING, Placement, Samples, Texels
from uplift.models.model import Model
from uplift.models.moments import Moments, warped
from uplift.models.sigmoid import Sigmoid

HASH_ROUNDS = 3
ARCTAN = (
    0.49999966,
    -0.318291775,
    0.249550106,
    -0.207882832,
    0.16639951,
    -0.10996833,
    0.048598712,
    -0.010096807,
)
"""arccos(c) / (π √(1 − c²)) on [0, 1] as a polynomial of c, lowered by its error to
keep reflectances in [0, 1].
"""


def blend(
    model: Model, multipliers: Sequence[Any], weights: Sequence[Any], wavelengths: Any
) -> Any:
    """Return the weighted sum of spectra at ``wavelengths``, a Mitsuba spectrum; each
    has C multipliers.
    """
    first, *functions = _basis(model, wavelengths)
    total = dr.zeros(type(wavelengths))
    for each, weight in zip(multipliers, weights, strict=True):
        linear = first * each[0]
        for order, function in enumerate(functions, start=1):
            linear = dr.fma(function, each[order], linear)
        total = dr.fma(weight, _to_reflectance(model, linear), total)
    return total


def _basis(model: Model, wavelengths: Any) -> list[Any]:
    """Return the C basis functions of the linear part at ``wavelengths``."""
    one = dr.ones(type(wavelengths))
    if isinstance(model, Sigmoid):
        middle = (model.start + model.end) / 2
        half = (model.end - model.start) / 2
        x = (dr.clip(wavelengths, model.start, model.end) - middle) / half
        return [x * x, x, one]
    assert isinstance(model, Moments)
    twice = 2 * dr.cos(_phase(model, wavelengths))
    functions = [one, twice, dr.fma(twice, twice, -2)]
    while len(functions) < model.count:
        functions.append(dr.fma(twice, functions[-1], -functions[-2]))
    return functions


def _to_reflectance(model: Model, linear: Any) -> Any:
    """Return the reflectance of a linear part x.

    The arc tangent is x c f(c) with c = 1 / √(1 + x²), its cosine, and f a polynomial.
    This needs no division, no branch and no range reduction. Reflectances differ by
    less than 1e-6.
    """
    cosine = dr.rsqrt(dr.fma(linear, linear, 1))
    sine = linear * cosine
    if isinstance(model, Sigmoid):
        return dr.fma(sine, 0.5, 0.5)
    series = dr.fma(cosine, ARCTAN[-1], ARCTAN[-2])
    for coefficient in ARCTAN[-3::-1]:
        series = dr.fma(series, cosine, coefficient)
    return dr.fma(series, sine, 0.5)


def _phase(model: Moments, wavelengths: Any) -> Any:
    low, high = warped(model.warp, np.array([model.start, model.end])).tolist()
    inside = warped(model.warp, dr.clip(wavelengths, model.start, model.end), dr.tanh)
    return dr.pi * (inside - low) / (high - low) - dr.pi


@cache
def _texture_class(variant: str) -> type:
    """Define the class for a variant, as each variant has its own base class."""

    class UpliftTexture(mi.Texture):  # type: ignore[misc]
        """Texture of spectra. Filters blend the spectra of texels, and thus their
        colours.
        """

        def __init__(self, props: Any, texels: Texels, placement: Placement) -> None:
            super().__init__(props)
            self.texels = texels
            self.placement = placement
            self.to_uv = mi.Transform3f(placement.to_uv.astype(np.float32))
            numbers = placement.pad(texels.numbers)
            nearest = dr.FilterMode.Nearest
            linear = dr.FilterMode.Linear
            if isinstance(texels.model, Samples):
                tensor = mi.TensorXf(numbers[..., None])
                self.numbers = mi.Texture3f(tensor, filter_mode=linear, use_accel=False)
            else:
                filtered = linear if placement.filter == "bilinear" else nearest
                self.numbers = mi.Texture2f(mi.TensorXf(numbers), filter_mode=filtered)

        def eval(self, si: Any, active: Any = True) -> Any:
            model = self.texels.model
            wavelengths = si.wavelengths
            is_bilinear = self.placement.filter == "bilinear"
            folded = _fold(self.to_uv @ si.uv, self.placement.wrap)
            # Place in the padded image, in texels, whose centres are at ½
            width, height = self.resolution()
            place = dr.fma(folded, mi.Vector2f(width, height), PADDING)
            if self.placement.filter == "stochastic":
                place += _offset(si)
            if isinstance(model, Samples):
                place = place if is_bilinear else dr.floor(place) + 0.5
                return _interpolate(self.numbers, model, place, wavelengths)
            height, width, _ = self.numbers.shape
            uv = place * mi.Vector2f(1 / width, 1 / height)
            if is_bilinear:
                texels = self.numbers.eval_fetch(uv)
                return blend(model, texels, _bilinear_weights(place), wavelengths)
            return blend(model, [self.numbers.eval(uv)], [mi.Float(1)], wavelengths)

        def mean(self) -> Any:
            return mi.Float(self.texels.mean)

        def is_spatially_varying(self) -> bool:
            return True

        def resolution(self) -> Any:
            height, width = self.texels.numbers.shape[:2]
            return mi.ScalarVector2i(width, height)

        def to_string(self) -> str:
            return self.texels.describe(self.placement.wrap)

    return UpliftTexture


def _fold(uv: Any, wrap: str) -> Any:
    """Return coordinates in [0, 1], outside of which an image is continued."""
    if wrap == "clamp":
        return dr.clip(uv, 0, 1)
    if wrap == "repeat":
        return uv - dr.floor(uv)
    return dr.abs(uv - 2 * dr.round(uv / 2))


def _offset(si: Any) -> Any:
    """Return up to half a texel, by which the nearest texel is one of four with the
    probability of its weight.

    Textures have no sampler: pseudo-random numbers are hashed from coordinates and
    wavelengths.
    """
    v = _bits(si.uv.y)
    seed = _bits(si.uv.x) ^ _bits(si.wavelengths[0])
    first, second = mi.sample_tea_32(seed, v, HASH_ROUNDS)
    return mi.Vector2f(mi.Float(first), mi.Float(second)) * 2.0**-32 - 0.5


def _interpolate(numbers: Any, model: Samples, place: Any, wavelengths: Any) -> Any:
    """Return reflectances between samples, which lie along the first axis of a
    texture.
    """
    height, width, depth, _ = numbers.shape
    uv = place * mi.Vector2f(1 / width, 1 / height)
    steps = (model.count - 1) / (model.end - model.start)
    from_start = dr.clip(wavelengths, model.start, model.end) - model.start
    samples = [
        numbers.eval(mi.Point3f(layer / depth, uv.x, uv.y))[0]
        for layer in from_start * steps + 0.5
    ]
    return type(wavelengths)(*samples)


def make_texture(props: Any, texels: Texels, placement: Placement) -> Any:
    """Return a texture of the current variant."""
    return _texture_class(mi.variant())(props, texels, placement)


@cache
def _environment_class(variant: str) -> type:
    class UpliftEnvironment(mi.Emitter):  # type: ignore[misc]
        """Directions are sampled by a grey ``envmap``, radiance is that of spectra."""

        def __init__(self, props: Any, texels: Texels) -> None:
            super().__init__(props)
            self.scale = float(props.get("scale", 1.0))
            transform = props.get("to_world", mi.ScalarTransform4f())
            inverse = np.array(transform.inverse().matrix, dtype=np.float32)
            self.to_local = mi.Transform4f(inverse)
            placement = Placement("bilinear", "repeat", np.eye(3))
            self.texture = make_texture(mi.Properties("uplift"), texels, placement)
            self.sampler = _grey_environment(texels, transform)
            self.m_flags = self.sampler.flags()

        def set_scene(self, scene: Any) -> None:
            """Take the bounding sphere of the scene."""
            self.sampler.set_scene(scene)

        def eval(self, si: Any, active: Any = True) -> Any:
            return self._radiance(-si.wi, si.wavelengths, active)

        def eval_direction(self, it: Any, ds: Any, active: Any = True) -> Any:
            return self._radiance(ds.d, it.wavelengths, active)

        def sample_direction(self, it: Any, sample: Any, active: Any = True) -> Any:
            """Sample a direction by the mean power; return radiance over density."""
            ds, _ = self.sampler.sample_direction(it, sample, active)
            radiance = self._radiance(ds.d, it.wavelengths, active)
            ds.emitter = self if variant.startswith("scalar") else mi.EmitterPtr(self)
            return ds, dr.select(ds.pdf > 0, radiance / ds.pdf, 0)

        def pdf_direction(self, it: Any, ds: Any, active: Any = True) -> Any:
            return self.sampler.pdf_direction(it, ds, active)

        def sample_ray(
            self,
            time: Any,
            sample1: Any,
            sample2: Any,
            sample3: Any,
            active: Any = True,
        ) -> Any:
            """Sample a ray into the scene; return power over density."""
            ray, weight = self.sampler.sample_ray(
                time, sample1, sample2, sample3, active
            )
            si = dr.zeros(mi.SurfaceInteraction3f)
            si.wavelengths = ray.wavelengths
            si.wi = ray.d
            grey = self.sampler.eval(si, active)
            radiance = self._radiance(-ray.d, ray.wavelengths, active)
            return ray, dr.select(grey > 0, weight * radiance / grey, 0)

        def sample_wavelengths(self, si: Any, sample: Any, active: Any = True) -> Any:
            """Sample wavelengths as sensors do; return radiance over density."""
            wavelengths, weight = mi.sample_rgb_spectrum(mi.sample_shifted(sample))
            return wavelengths, weight * self._radiance(-si.wi, wavelengths, active)

        def bbox(self) -> Any:
            """Return an empty box: the environment has no surface."""
            return self.sampler.bbox()

        def to_string(self) -> str:
            name = self.texture.to_string()
            return name.replace("UpliftTexture", "UpliftEnvironment")

        def _radiance(self, direction: Any, wavelengths: Any, active: Any) -> Any:
            """Return the radiance from a direction, laid out as in ``envmap``."""
            si = dr.zeros(mi.SurfaceInteraction3f)
            height = self.texture.texels.numbers.shape[0]
            si.uv = _uv_of(self.to_local @ direction, height)
            si.wavelengths = wavelengths
            return self.scale * self.texture.eval(si, active)

    return UpliftEnvironment


def _grey_environment(texels: Texels, transform: Any) -> Any:
    """Return Mitsuba's ``envmap`` of the mean of the numbers of texels."""
    grey = np.repeat(texels.numbers.mean(axis=2, keepdims=True), 3, axis=2)
    bitmap = mi.Bitmap(np.ascontiguousarray(grey))
    return mi.load_dict({"type": "envmap", "bitmap": bitmap, "to_world": transform})


def _uv_of(local: Any, height: int) -> Any:
    """Return the coordinates of a direction in an image, whose first and last row lie
    at the poles.
    """
    u = dr.atan2(local.x, -local.z) / (2 * dr.pi)
    v = dr.safe_acos(local.y) / dr.pi
    return mi.Point2f(u - dr.floor(u), (v * (height - 1) + 0.5) / height)


def make_environment(props: Any, texels: Texels) -> Any:
    """Return an environment of the current variant."""
    return _environment_class(mi.variant())(props, texels)


def _bilinear_weights(place: Any) -> tuple[Any, ...]:
    x = place.x - 0.5
    y = place.y - 0.5
    x = x - dr.floor(x)
    y = y - dr.floor(y)
    return (1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y


def _bits(number: Any) -> Any:
    """Return the bits of a float as an unsigned integer."""
    if isinstance(number, float):  # scalar variants
        return int(np.float32(number).view(np.uint32))
    return dr.reinterpret_array(mi.UInt32, number)
