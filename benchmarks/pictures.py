"""Images distributed with scikit-image, scikit-learn, colour-science and matplotlib."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

from benchmarks import ROOT
from uplift.common.arrays import Array

with warnings.catch_warnings(action="ignore"):  # of its optional parts
    import colour

INSTALLED = ROOT / "out" / "pictures"
"""Folder into which `make pictures` installs packages with images."""


@dataclass(frozen=True, eq=False)
class Picture:
    """An image file, its package, the RGB space that it states, and its linear sRGB as
    read by other software.
    """

    path: Path
    package: str
    space: str = "sRGB"

    def linear(self) -> Array:
        """Return linear sRGB (h, w, 3), by OpenEXR, or by Pillow and colour-science."""
        if self.path.suffix == ".exr":
            import OpenEXR

            channels = OpenEXR.File(str(self.path)).channels()
            return channels["RGB"].pixels.astype(float)
        from PIL import Image

        codes = np.asarray(Image.open(self.path).convert("RGB"))
        linear = colour.RGB_COLOURSPACES[self.space].cctf_decoding(codes / 255)
        if self.space == "sRGB":
            return linear
        return colour.RGB_to_RGB(linear, self.space, "sRGB", None)


def pictures() -> Iterator[Picture]:
    """Yield the images. Raises `FileNotFoundError` before `make pictures`."""
    if not INSTALLED.is_dir():
        raise FileNotFoundError(f"{INSTALLED}: run 'make pictures'")
    folder = INSTALLED / "skimage" / "data"
    for name in ("astronaut.png", "coffee.png", "chelsea.png", "ihc.png"):
        yield Picture(folder / name, "scikit-image")
    yield Picture(folder / "rocket.jpg", "scikit-image", "Adobe RGB (1998)")
    for name in ("china.jpg", "flower.jpg"):
        yield Picture(INSTALLED / "sklearn/datasets/images" / name, "scikit-learn")
    resources = Path(colour.__file__).parent / "io" / "tests" / "resources"
    yield Picture(resources / "CMS_Test_Pattern.exr", "colour-science")
    portrait = Path(matplotlib.get_data_path()) / "sample_data" / "grace_hopper.jpg"
    yield Picture(portrait, "matplotlib")
