"""Settings of the images of one pass, which other processes prepare."""

from dataclasses import dataclass, field
from typing import Any

from uplift.extras.emission.lookup import load_emission
from uplift.extras.images.converter import Converter
from uplift.extras.scene.passes.file import read_passes
from uplift.extras.scene.passes.light_images import prepare_light_pass
from uplift.extras.scene.passes.textures import prepare_pass
from uplift.extras.texture.sequence import TextureSettings
from uplift.lookup.cube import load


@dataclass(frozen=True)
class PassSettings(TextureSettings):
    """Settings of the textures of one pass.

    Parameters
    ----------
    passes : str
        Path of the passes.
    number : int
        Number of the pass, from 1.
    """

    passes: str = field(default="", kw_only=True)
    number: int = field(default=1, kw_only=True)

    def prepare(self) -> Converter:
        """Prepare the cube or the emission table for a pass.

        Returns
        -------
        Converter
            The converter to pass to `uplift.extras.texture.convert`.
        """
        passes = read_passes(self.passes)
        shared: dict[str, Any] = {
            name: getattr(self, name)
            for name in ("depth", "encoding", "space", "threads")
        }
        if self.emission:
            table = load_emission(self.cubes[0])
            return prepare_light_pass(table, passes, self.number, **shared)
        cube = load(self.cubes[0])
        if self.fill_missing:
            cube = cube.fill_missing(threads=self.threads)
        shared["out_of_gamut"] = self.out_of_gamut
        return prepare_pass(cube, passes, self.number, **shared)
