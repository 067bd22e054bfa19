"""Settings of the images of one pass, which other processes prepare."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace

from uplift.extras.emission.lookup import load_emission
from uplift.extras.images.converter import Converter
from uplift.extras.scene.passes.file import read_passes
from uplift.extras.scene.passes.light_images import prepare_light_pass
from uplift.extras.scene.passes.textures import pass_name, prepare_pass
from uplift.extras.texture.sequence import Job, TextureSettings


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
        if self.emission:
            table = load_emission(self.cubes[0])
            return prepare_light_pass(table, passes, self.number, **self._shared)
        (cube,) = self._load_cubes()
        return prepare_pass(
            cube,
            passes,
            self.number,
            out_of_gamut=self.out_of_gamut,
            **self._shared,
        )


def jobs_of_passes(jobs: Sequence[Job], path: str) -> list[Job]:
    """Return a job for each image and pass of the file, the images of a pass in a
    row.
    """
    settings = jobs[0].settings
    shared = {item.name: getattr(settings, item.name) for item in fields(settings)}
    result = []
    for number in range(1, read_passes(path).count + 1):
        of_pass = PassSettings(**shared, passes=path, number=number)
        for job in jobs:
            target = job.target.with_name(pass_name(job.target.stem, number))
            result.append(replace(job, settings=of_pass, target=target))
    return result
