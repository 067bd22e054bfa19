"""What a pixel of a texture holds: a spectrum, moments or multipliers, in half or single precision."""

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
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_size

DEPTHS: dict[str, DTypeLike] = {"half": np.float16, "float": np.float32}


@dataclass(frozen=True)
class Storage:
    """A form of `uplift.io.texture` by its name, and a depth."""

    form: str
    depth: str

    def size(self, cube: Cube, wavelengths: Array) -> int:
        """Bytes of a pixel, before compression, without the RGB that lies beside."""
        numbers = len(wavelengths) if self.form == texture.Spectrum.name else cube.data.model.count
        return numbers * np.dtype(DEPTHS[self.depth]).itemsize

    def read_back(self, cube: Cube, rgb: Array, wavelengths: Array) -> Array:
        """Reflectances (n, K) at wavelengths (K,) nm that a renderer finds in a texture of linear RGB (n, 3).

        NaN where rounding has left moments that no spectrum has.
        """
        sample = _form(self.form, wavelengths).make_sampler(cube, 1)
        held = sample(rgb.astype(np.float32)).astype(DEPTHS[self.depth]).astype(float)
        model = cube.data.model
        if self.form == texture.Spectrum.name:
            return held
        if self.form == texture.Multipliers.name:
            return evaluate(model, held, wavelengths)
        try:
            return reflectance(model, held, wavelengths)
        except UpliftError:
            return np.full((len(rgb), len(wavelengths)), np.nan)


STORAGES = tuple(
    Storage(name, depth) for name, form in texture.PIXEL_ENCODINGS.items() for depth in form().depths
)


def choose_storage(
    context: PlanContext, question: EvaluationSet, limit: float, cube: Cube, sampling: Sampling
) -> Decision:
    """By the bytes of a pixel; at the same size spectra first, which take nothing to evaluate."""
    at = sampling.wavelengths
    order = sorted(STORAGES, key=lambda each: each.size(cube, at))

    def trials() -> Iterator[Trial]:
        for done, each in enumerate(order):
            context.progress(Progress(f"{each.form} as {each.depth}", done, len(order)))
            error = question.seen(sampling.xyz(each.read_back(cube, question.rgb, at)))
            size = each.size(cube, at)
            choice: dict[str, Any] = {"as": each.form, "depth": each.depth}
            typed = f"--store {each.form} --depth {each.depth}"
            yield Trial(
                f"{each.form}, {each.depth}", size, f"{format_size(size)} a pixel", typed, choice, error
            )

    return decide("storage", "A texture's pixel", "bytes a pixel", limit, trials())


def _form(name: str, wavelengths: Array) -> texture.PixelEncoding:
    if name == texture.Spectrum.name:
        return texture.Spectrum(tuple(wavelengths.tolist()))
    return texture.PIXEL_ENCODINGS[name]()
