"""Conversion of many images, in the processes of this machine or on a Dask cluster."""

import contextlib
import logging
import os
from collections import defaultdict
from collections.abc import Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, as_completed
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from uplift.colorimetry.illuminants import Illuminant
from uplift.common.errors import (
    OptionError,
    OutputError,
    StrPath,
    TextureError,
    UpliftError,
    needs_package,
)
from uplift.common.files import remove_stale
from uplift.common.progress import ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.emission.lookup import load_emission
from uplift.extras.files.outputs import check_folder, make_folder
from uplift.extras.images import exr_file
from uplift.extras.images.converter import Converter
from uplift.extras.images.image import open_image
from uplift.extras.processes import TiedProcesses
from uplift.extras.texture.conversion import SOURCE, Conversion, convert, source_stamp
from uplift.extras.texture.emission import prepare_lights
from uplift.extras.texture.encodings import PixelEncoding, Spectrum
from uplift.extras.texture.mask import prepare_masked
from uplift.extras.texture.photographs import FurtherPictures
from uplift.extras.texture.several_lights import prepare_several_lights
from uplift.extras.texture.uplifter import prepare
from uplift.lookup.cube import Cube, load

DASK_TIMEOUT = "10s"
DASK_CLOSE_SECONDS = 2


@lru_cache(maxsize=4)
def load_cube(path: str | None) -> Cube:
    """Load a cube, which each process does once."""
    return load(path)


@dataclass(frozen=True)
class TextureSettings:
    """Settings that all images of a sequence share. They are small enough to send to
    other processes.

    Parameters
    ----------
    cubes : tuple of str or None
        Path of the cube, or of the emission table; None for the default one. Several
        for a ``mask``.
    pixel_encoding : PixelEncoding
        Numbers that a pixel holds: a `Spectrum` for ``emission``.
    depth : {"half", "float"} or None
        Type of the channels, None for the default of the pixel encoding.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1]; not used for ``emission``.
    space : str or None
        RGB space of the images, None for the one that each file states.
    errors : tuple of str or Lamp
        Lights whose standard errors have a channel; not used for ``emission``.
    mask : str or None
        Path of the image of which cube a pixel belongs to; see
        `uplift.extras.texture.mask`.
    emission : bool
        Whether pixels are light; see `prepare_lights`.
    fill_missing : bool
        Whether to add the nodes that a cube built for a scene lacks
        (`Cube.fill_missing`).
    threads : int
        Threads per process.
    also : FurtherPictures or None
        Further photographs of each image, under other lights.
    """

    cubes: tuple[str | None, ...] = (None,)
    pixel_encoding: PixelEncoding = field(default_factory=Spectrum)
    depth: str | None = None
    encoding: str = "auto"
    out_of_gamut: str = "clip"
    space: str | None = None
    errors: tuple[Illuminant, ...] = ()
    mask: str | None = None
    emission: bool = False
    fill_missing: bool = False
    threads: int = 2
    also: FurtherPictures | None = None

    def prepare(self) -> Converter:
        """Prepare the cubes or the emission table for textures.

        Returns
        -------
        Converter
            The converter to pass to `convert`.
        """
        encoding = self.pixel_encoding
        if self.emission:
            at = getattr(encoding, "wavelengths", None)
            return prepare_lights(load_emission(self.cubes[0]), at, **self._shared)
        uplifters = [
            prepare(
                cube,
                encoding,
                out_of_gamut=self.out_of_gamut,
                errors=self.errors,
                **self._shared,
            )
            for cube in self._load_cubes()
        ]
        mask = None if self.mask is None else Path(self.mask)
        if self.also is not None:
            return prepare_several_lights(
                uplifters,
                encoding,
                self.also,
                errors=self.errors,
                mask=mask,
                threads=self.threads,
            )
        return uplifters[0] if mask is None else prepare_masked(uplifters, mask)

    @property
    def _shared(self) -> dict[str, Any]:
        """What all converters have in common."""
        names = ("depth", "encoding", "space", "threads")
        return {name: getattr(self, name) for name in names}

    def _load_cubes(self) -> list[Cube]:
        """Load the cubes, with all nodes if those of a scene are to be added."""
        cubes = [load_cube(path) for path in self.cubes]
        if self.fill_missing:
            cubes = [cube.fill_missing(threads=self.threads) for cube in cubes]
        return cubes


@dataclass(frozen=True)
class Job:
    """The conversion of one image.

    Parameters
    ----------
    settings : TextureSettings
        Settings of the sequence.
    source, target : Path
        The image to read and the file to write.
    force : bool
        Whether to replace an existing file.
    resume : bool
        Whether to leave out an image whose texture is complete.
    also : tuple of Path
        Further photographs of the image, for ``settings.also``.
    """

    settings: TextureSettings
    source: Path
    target: Path
    force: bool = False
    resume: bool = False
    also: tuple[Path, ...] = ()


@dataclass(frozen=True)
class Failure:
    """An image that could not be converted.

    Parameters
    ----------
    source : Path
        The image.
    error : UpliftError
        The reason.
    """

    source: Path
    error: UpliftError


@dataclass(frozen=True)
class Skipped:
    """An image whose texture another process has completed meanwhile.

    Parameters
    ----------
    source : Path
        The image.
    """

    source: Path


Outcome = Conversion | Failure | Skipped
"""What becomes of a job."""


@lru_cache(maxsize=1)
def converter_for(settings: TextureSettings) -> Converter:
    """Prepare the converter of settings, which each process does once."""
    return settings.prepare()


def run(job: Job, progress: ProgressCallback = ignore_progress) -> Outcome:
    """Convert the image of a job. Errors are returned, so that one bad image does not
    stop the others.
    """
    try:
        return _run(job, progress)
    except UpliftError as error:
        return Failure(job.source, error)
    except MemoryError:
        return Failure(
            job.source,
            TextureError(
                "not enough memory", path=job.source, hint="use fewer processes"
            ),
        )


def _run(job: Job, progress: ProgressCallback) -> Outcome:
    """Convert the image of a job, unless another process does so while it
    is to resume.
    """
    make_folder(job.target.parent)
    if job.resume and is_complete(job):
        return Skipped(job.source)
    try:
        return convert(
            converter_for(job.settings),
            job.source,
            job.target,
            also=job.also,
            force=job.force,
            progress=progress,
        )
    except OutputError as error:
        if job.resume and error.code == "file-exists" and is_complete(job):
            return Skipped(job.source)
        raise


def convert_all(
    jobs: Iterable[Job], *, processes: int = 1, scheduler: str | None = None
) -> Generator[Outcome]:
    """Convert images one after the other, in several processes, or on a Dask cluster.

    An exception and closing the iterator end the conversions. Unfinished files are
    removed, also when this process ends.

    Parameters
    ----------
    jobs : iterable of Job
        The images.
    processes : int
        Number of processes; 1 converts in the current process.
    scheduler : str, optional
        Address of a Dask scheduler, such as ``tcp://10.0.0.5:8786``, whose workers
        share the file system.

    Yields
    ------
    Conversion, Failure or Skipped
        Outcomes in order of completion.

    Raises
    ------
    OptionError
        The number of processes is below 1, Dask is not installed, or no scheduler
        responds.
    TextureError
        The workers ended before all images were converted. Textures that are finished
        stay; no other file remains.
    """
    if processes < 1:
        raise OptionError(
            f"the number of processes must be at least 1, got {processes}",
            hint="use 1 or more",
        )
    jobs = list(jobs)
    if scheduler is None and processes == 1:
        yield from map(run, jobs)
        return
    workers: AbstractContextManager[Executor] = (
        TiedProcesses(processes) if scheduler is None else _dask_executor(scheduler)
    )
    finished = set[Path]()
    try:
        with workers as executor:
            for future in as_completed([executor.submit(run, job) for job in jobs]):
                result = future.result()
                if isinstance(result, Conversion):
                    finished.add(result.target)
                yield result
    except Exception as error:
        is_of_dask = type(error).__module__.partition(".")[0] == "distributed"
        lost = BrokenExecutor | CancelledError | TimeoutError
        if not is_of_dask and not isinstance(error, lost):
            raise
        for job in jobs:
            if job.target not in finished:
                with contextlib.suppress(OSError):
                    remove_stale(job.target, seconds=0)
        raise TextureError(
            f"the workers ended unexpectedly; finished: {len(finished)} of "
            f"{pluralise(len(jobs), 'texture')}",
            code="workers-lost",
            hint="resume with the others, with fewer processes if memory ran out",
        ) from error


def import_distributed() -> Any:
    """Import Dask's package for clusters. Raises `OptionError` if it is not
    installed.
    """
    with needs_package("clusters", OptionError):
        import distributed
    return distributed


@contextlib.contextmanager
def _dask_executor(address: str) -> Iterator[Executor]:
    """Connect to a cluster. Raises `OptionError`."""
    distributed = import_distributed()
    with contextlib.ExitStack() as stack:
        # lost connections are raised as errors
        for handler in logging.getLogger("distributed").handlers:
            stack.callback(handler.setLevel, handler.level)
            handler.setLevel(logging.CRITICAL + 1)
        try:
            client = distributed.Client(address, timeout=DASK_TIMEOUT)
        # each protocol has its own, such as RuntimeError for missing certificates
        except Exception as error:
            problem = (
                f"no Dask scheduler can be used at '{address}': "
                f"{' '.join(str(error).split())}"
            )
            raise OptionError(problem, hint="start one: dask scheduler") from error
        try:
            yield client.get_executor()
        finally:
            with contextlib.suppress(Exception):  # of a scheduler that has ended
                client.close(timeout=DASK_CLOSE_SECONDS)


def pending(jobs: Iterable[Job], *, inputs: Iterable[StrPath | None] = ()) -> list[Job]:
    """Return the jobs that remain, and check that their targets can be written, without
    creating folders.

    Parameters
    ----------
    jobs : iterable of Job
        All jobs.
    inputs : iterable of path-like
        Further files that are read, as well as those of the jobs.

    Returns
    -------
    list of Job
        The jobs but those that resume and whose textures are complete: these agree with
        their checksums, and are of the same cube, settings and image.

    Raises
    ------
    OutputError
        A target cannot be written, exists, or is an image or the cube of any job, or
        two images have the same target. A texture from which a job could resume was
        written otherwise (``texture-differs``).
    """
    jobs = list(jobs)
    read = list(inputs)
    for job in jobs:
        read += [job.source, *job.also, *job.settings.cubes, job.settings.mask]
    _check_targets(jobs, read, force=True)
    remaining = [job for job in jobs if not (job.resume and is_complete(job))]
    new = [job for job in remaining if not job.force]
    _check_targets(new, read, force=False)
    return remaining


def _check_targets(
    jobs: list[Job], inputs: Iterable[StrPath | None], *, force: bool
) -> None:
    """Check textures by their folders, which `run` creates."""
    folders = defaultdict[Path, list[str]](list)
    for job in jobs:
        folders[job.target.parent].append(job.target.name)
    for folder, names in folders.items():
        check_folder(folder, names, inputs=inputs, force=force)


def is_complete(job: Job) -> bool:
    """Return whether the texture of a job is there, intact, and of the same cube,
    settings and image.

    Raises `OutputError` (``texture-differs``) if another file is there that the job may
    not replace.
    """
    if not os.path.lexists(job.target):
        return False
    problem = _difference(job)
    if problem and not job.force:
        hint = "pass force=True to convert the image again, or choose another name"
        raise OutputError(
            f"exists, but {problem}", code="texture-differs", path=job.target, hint=hint
        )
    return not problem


def _difference(job: Job) -> str:
    """Return how a file differs from the texture of a job; empty if it does not."""
    header = converter_for(job.settings).header
    names = (SOURCE, "uplift.cube", "uplift.texture")
    try:
        with open_image(job.target) as image:
            source, cube, settings = (image.header_text(name) for name in names)
    except TextureError:
        return "is not a complete texture"
    if cube != header["uplift.cube"]:
        return "is a texture of another cube"
    if settings != header["uplift.texture"]:
        return "was written with other options"
    if source != source_stamp(job.source, *job.also):
        return "is a texture of another image, or of one that has changed"
    return "" if exr_file.is_intact(job.target) else "is not a complete texture"
