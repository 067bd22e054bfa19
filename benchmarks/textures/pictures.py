"""Real images: those that come with scikit-image, scikit-learn, colour-science and matplotlib."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

from benchmarks.timing import ROOT
from uplift.common.arrays import Array

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of its optional parts
    import colour

BROUGHT = ROOT / "out" / "pictures"
"""Where `make textures` puts the packages whose pictures are looked at."""


@dataclass(frozen=True, eq=False)
class Picture:
    """An image file, whose it is, and its linear sRGB as others read it."""

    path: Path
    package: str

    def linear(self) -> Array:
        """(h, w, 3) linear sRGB: OpenEXR's own reader, or Pillow and colour-science's sRGB curve."""
        if self.path.suffix == ".exr":
            import OpenEXR

            found = OpenEXR.File(str(self.path)).channels()
            return np.asarray(found["RGB"].pixels, dtype=float)
        from PIL import Image

        codes: Any = np.asarray(Image.open(self.path).convert("RGB"), dtype=float)
        return np.asarray(colour.models.eotf_sRGB(codes / 255), dtype=float)


def pictures() -> Iterator[Picture]:
    """Raises `FileNotFoundError` where `make textures` did not bring them."""
    if not BROUGHT.is_dir():
        raise FileNotFoundError(f"{BROUGHT}: run 'make textures'")
    for name in ("astronaut.png", "coffee.png", "chelsea.png", "ihc.png", "rocket.jpg"):
        yield Picture(BROUGHT / "skimage" / "data" / name, "scikit-image")
    for name in ("china.jpg", "flower.jpg"):
        yield Picture(BROUGHT / "sklearn" / "datasets" / "images" / name, "scikit-learn")
    test_pattern = Path(colour.__file__).parent / "io" / "tests" / "resources" / "CMS_Test_Pattern.exr"
    yield Picture(test_pattern, "colour-science")
    portrait = Path(matplotlib.get_data_path()) / "sample_data" / "grace_hopper.jpg"
    yield Picture(portrait, "matplotlib")
