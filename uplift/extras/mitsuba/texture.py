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
from uplift.models import Model, Moments, Sigmoid
from uplift.models.moments import warped

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
            place = self._texel(self.to_uv @ si.uv)
            if self.placement.filter == "stochastic":
                place += self._offset(si)
            if isinstance(self.texels.model, Samples):
                return self._interpolated(place, si.wavelengths, active)
            height, width, _ = self.numbers.shape
            uv = place * mi.Vector2f(1 / width, 1 / height)
            if self.placement.filter != "bilinear":
                return blend(
                    self.texels.model,
                    [self.numbers.eval(uv)],
                    [mi.Float(1)],
                    si.wavelengths,
                )
            texels = self.numbers.eval_fetch(uv)
            return blend(
                self.texels.model, texels, _bilinear_weights(place), si.wavelengths
            )

        def _texel(self, uv: Any) -> Any:
            """Return the place of coordinates in the padded image, in texels; centres
            of texels are at ½.
            """
            if self.placement.wrap == "clamp":
                folded = dr.clip(uv, 0, 1)
            elif self.placement.wrap == "repeat":
                folded = uv - dr.floor(uv)
            else:
                folded = dr.abs(uv - 2 * dr.round(uv / 2))
            width, height = self.resolution()
            return dr.fma(folded, mi.Vector2f(width, height), PADDING)

        def _offset(self, si: Any) -> Any:
            """Return up to half a texel, by which the nearest texel is one of four with
            the probability of its weight.

            Textures have no sampler: pseudo-random numbers are hashed from coordinates
            and wavelengths.
            """
            u, v, wavelength = (
                _bits(each) for each in (si.uv.x, si.uv.y, si.wavelengths[0])
            )
            first, second = mi.sample_tea_32(u ^ wavelength, v, HASH_ROUNDS)
            return mi.Vector2f(mi.Float(first), mi.Float(second)) * 2.0**-32 - 0.5

        def _interpolated(self, place: Any, wavelengths: Any, active: Any) -> Any:
            """Return reflectances between samples, which lie along the first axis of
            the texture.
            """
            model, (height, width, depth, _) = self.texels.model, self.numbers.shape
            assert isinstance(model, Samples)
            if self.placement.filter != "bilinear":
                place = dr.floor(place) + 0.5
            uv = place * mi.Vector2f(1 / width, 1 / height)
            steps = (model.count - 1) / (model.end - model.start)
            samples = (
                dr.clip(wavelengths, model.start, model.end) - model.start
            ) * steps + 0.5
            return type(wavelengths)(
                *(
                    self.numbers.eval(mi.Point3f(each / depth, uv.x, uv.y))[0]
                    for each in samples
                )
            )

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


def make_texture(props: Any, texels: Texels, placement: Placement) -> Any:
    """Return a texture of the current variant."""
    return _texture_class(mi.variant())(props, texels, placement)


@cache
def _environment_class(variant: str) -> type:
    class UpliftEnvironment(mi.Emitter):  # type: ignore[misc]
        """Mitsuba's ``envmap`` in grey samples directions, and the spectra give the
        radiance.
        """

        def __init__(self, props: Any, texels: Texels) -> None:
            super().__init__(props)
            self.scale = float(props.get("scale", 1.0))
            transform = props.get("to_world", mi.ScalarTransform4f())
            self.to_local = mi.Transform4f(
                np.array(transform.inverse().matrix, dtype=np.float32)
            )
            placement = Placement("bilinear", "repeat", np.eye(3))
            self.texture = make_texture(mi.Properties("uplift"), texels, placement)
            grey = np.repeat(texels.numbers.mean(axis=2, keepdims=True), 3, axis=2)
            bitmap = mi.Bitmap(np.ascontiguousarray(grey))
            self.sampler = mi.load_dict(
                {"type": "envmap", "bitmap": bitmap, "to_world": transform}
            )
            self.m_flags = self.sampler.flags()

        def set_scene(self, scene: Any) -> None:
            """Take the bounding sphere of the scene."""
            self.sampler.set_scene(scene)

        def eval(self, si: Any, active: Any = True) -> Any:
            return self._radiance(-si.wi, si.wavelengths, active)

        def eval_direction(self, it: Any, ds: Any, active: Any = True) -> Any:
            return self._radiance(ds.d, it.wavelengths, active)

        def sample_direction(self, it: Any, sample: Any, active: Any = True) -> Any:
            """Sample a direction in proportion to the mean power, and return it with
            radiance over density.
            """
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
            """Sample a ray into the scene, and return it with power over density."""
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
            """Sample wavelengths as Mitsuba does for sensors, and return them with
            radiance over density.
            """
            wavelengths, weight = mi.sample_rgb_spectrum(mi.sample_shifted(sample))
            return wavelengths, weight * self._radiance(-si.wi, wavelengths, active)

        def bbox(self) -> Any:
            """Return an empty box: the environment has no surface."""
            return self.sampler.bbox()

        def to_string(self) -> str:
            return self.texture.to_string().replace(
                "UpliftTexture", "UpliftEnvironment"
            )

        def _radiance(self, direction: Any, wavelengths: Any, active: Any) -> Any:
            """Return the radiance from a direction, with the layout of Mitsuba's
            ``envmap``.
            """
            local = self.to_local @ direction
            u = dr.atan2(local.x, -local.z) / (2 * dr.pi)
            v = dr.safe_acos(local.y) / dr.pi
            height = self.texture.texels.numbers.shape[0]
            si = dr.zeros(mi.SurfaceInteraction3f)
            # The first and the last row lie at the poles.
            si.uv = mi.Point2f(u - dr.floor(u), (v * (height - 1) + 0.5) / height)
            si.wavelengths = wavelengths
            return self.scale * self.texture.eval(si, active)

    return UpliftEnvironment


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
