"""The emitter plugin ``uplift_envmap``: an environment of spectral power around a scene."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from uplift.io.mitsuba.texels import Placement, Texels
from uplift.io.mitsuba.texture import make_texture


@cache
def _environment_class(variant: str) -> type:
    """Define the class for a variant, as each variant has its own base class."""
    import drjit as dr
    import mitsuba as mi

    class UpliftEnvironment(mi.Emitter):  # type: ignore[misc]
        """Mitsuba's ``envmap`` in grey samples directions, and the spectra give the radiance."""

        def __init__(self, props: Any, texels: Texels) -> None:
            super().__init__(props)
            self.scale = float(props.get("scale", 1.0))
            transform = props.get("to_world", mi.ScalarTransform4f())
            self.to_local = mi.Transform4f(np.array(transform.inverse().matrix, dtype=np.float32))
            placement = Placement("bilinear", "repeat", np.eye(3))
            self.texture = make_texture(mi.Properties("uplift"), texels, placement)
            grey = np.repeat(texels.numbers.mean(axis=2, keepdims=True), 3, axis=2)
            bitmap = mi.Bitmap(np.ascontiguousarray(grey))
            self.sampler = mi.load_dict({"type": "envmap", "bitmap": bitmap, "to_world": transform})
            self.m_flags = self.sampler.flags()

        def set_scene(self, scene: Any) -> None:
            """Take the bounding sphere of the scene."""
            self.sampler.set_scene(scene)

        def eval(self, si: Any, active: Any = True) -> Any:
            """Return the radiance that comes from where the ray goes."""
            return self._radiance(-si.wi, si.wavelengths, active)

        def eval_direction(self, it: Any, ds: Any, active: Any = True) -> Any:
            """Return the radiance from a sampled direction."""
            return self._radiance(ds.d, it.wavelengths, active)

        def sample_direction(self, it: Any, sample: Any, active: Any = True) -> Any:
            """Sample a direction in proportion to the mean power, and return it with radiance over density."""
            ds, _ = self.sampler.sample_direction(it, sample, active)
            radiance = self._radiance(ds.d, it.wavelengths, active)
            ds.emitter = self if variant.startswith("scalar") else mi.EmitterPtr(self)
            return ds, dr.select(ds.pdf > 0, radiance / ds.pdf, 0)

        def pdf_direction(self, it: Any, ds: Any, active: Any = True) -> Any:
            """Return the density of a direction."""
            return self.sampler.pdf_direction(it, ds, active)

        def sample_ray(self, time: Any, sample1: Any, sample2: Any, sample3: Any, active: Any = True) -> Any:
            """Sample a ray into the scene, and return it with power over density."""
            ray, weight = self.sampler.sample_ray(time, sample1, sample2, sample3, active)
            si = dr.zeros(mi.SurfaceInteraction3f)
            si.wavelengths, si.wi = ray.wavelengths, ray.d
            grey = self.sampler.eval(si, active)
            radiance = self._radiance(-ray.d, ray.wavelengths, active)
            return ray, dr.select(grey > 0, weight * radiance / grey, 0)

        def sample_wavelengths(self, si: Any, sample: Any, active: Any = True) -> Any:
            """Sample wavelengths as Mitsuba does for sensors, and return them with radiance over density."""
            wavelengths, weight = mi.sample_rgb_spectrum(mi.sample_shifted(sample))
            return wavelengths, weight * self._radiance(-si.wi, wavelengths, active)

        def bbox(self) -> Any:
            """Return an empty box: the environment has no surface."""
            return self.sampler.bbox()

        def to_string(self) -> str:
            """Return a summary."""
            return self.texture.to_string().replace("UpliftTexture", "UpliftEnvironment")

        def _radiance(self, direction: Any, wavelengths: Any, active: Any) -> Any:
            """Return the radiance from a direction, with the layout of Mitsuba's ``envmap``."""
            local = self.to_local @ direction
            u, v = dr.atan2(local.x, -local.z) / (2 * dr.pi), dr.safe_acos(local.y) / dr.pi
            height = self.texture.texels.numbers.shape[0]
            si = dr.zeros(mi.SurfaceInteraction3f)
            # The first and the last row lie at the poles.
            si.uv = mi.Point2f(u - dr.floor(u), (v * (height - 1) + 0.5) / height)
            si.wavelengths = wavelengths
            return self.scale * self.texture.eval(si, active)

    return UpliftEnvironment


def make_environment(props: Any, texels: Texels) -> Any:
    """Return an environment of the current variant."""
    import mitsuba

    return _environment_class(mitsuba.variant())(props, texels)
