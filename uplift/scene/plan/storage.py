"""Choice of the values that a texture's pixel stores, and of their precision."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress
from uplift.io import texture
from uplift.lookup import Cube
from uplift.models import evaluate, reflectance
from uplift.scene.plan.arguments import storage_args
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_size

DEPTHS: dict[str, DTypeLike] = {"half": np.float16, "float": np.float32}


@dataclass(frozen=True)
class Storage:
    """Contents of a texture's pixel.

    Parameters
    ----------
    form : str
        Name of one of `uplift.io.texture.PIXEL_ENCODINGS`.
    depth : str
        "half" or "float".
    """

    form: str
    depth: str

    def bytes_per_pixel(self, cube: Cube, wavelengths: Array) -> int:
        """Size of a pixel before compression, without the RGB that textures also store."""
        count = len(wavelengths) if self.form == texture.Spectrum.name else cube.data.model.count
        return count * np.dtype(DEPTHS[self.depth]).itemsize

    def decoded_reflectance(self, cube: Cube, rgb: Array, wavelengths: Array) -> Array:
        """Reflectances (n, K) at wavelengths (K,) in nm that a renderer reads for linear RGB (n, 3).

        NaN where no spectrum has the rounded moments.
        """
        sample = _pixel_encoding(self.form, wavelengths).make_sampler(cube, 1)
        values = sample(rgb.astype(np.float32)).astype(DEPTHS[self.depth]).astype(float)
        model = cube.data.model
        if self.form == texture.Spectrum.name:
            return values
        if self.form == texture.Multipliers.name:
            return evaluate(model, values, wavelengths)
        try:
            return reflectance(model, values, wavelengths)
        except UpliftError:
            return np.full((len(rgb), len(wavelengths)), np.nan)


STORAGES = tuple(Storage(name, depth) for name, form in texture.PIXEL_ENCODINGS.items() for depth in form().depths)


def choose_storage(
    context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube, sampling: Sampling
) -> Decision:
    """Choose the smallest pixel; of equal sizes spectra first, which renderers need not evaluate."""
    wavelengths = sampling.wavelengths
    order = sorted(STORAGES, key=lambda storage: storage.bytes_per_pixel(cube, wavelengths))

    def trials() -> Iterator[Trial]:
        for done, storage in enumerate(order):
            form, depth = storage.form, storage.depth
            context.progress(Progress(f"{form} as {depth}", done, len(order)))
            spectra = storage.decoded_reflectance(cube, tests.rgb, wavelengths)
            error = tests.error_of_xyz(sampling.xyz(spectra))
            size = storage.bytes_per_pixel(cube, wavelengths)
            choice: dict[str, Any] = {"as": form, "depth": depth}
            cost = f"{format_size(size)} per pixel"
            yield Trial(f"{form}, {depth}", size, cost, storage_args(form, depth), choice, error)

    return decide("storage", "Texture pixel", "bytes per pixel", limit, trials())


def _pixel_encoding(form: str, wavelengths: Array) -> texture.PixelEncoding:
    if form == texture.Spectrum.name:
        return texture.Spectrum(tuple(wavelengths.tolist()))
    return texture.PIXEL_ENCODINGS[form]()
