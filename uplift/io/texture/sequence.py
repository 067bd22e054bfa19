"""Conversion of many images, in the processes of this machine or on a Dask cluster."""

from __future__ import annotations

import contextlib
import logging
import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    as_completed,
)
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from uplift.common.errors import OptionError, TextureError, UpliftError
from uplift.common.files import check_outputs, remove_stale
from uplift.common.processes import tied_processes
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.texture import exr_file
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.converter import Converter
from uplift.io.texture.lights import prepare_lights
from uplift.io.texture.masked import prepare_masked
from uplift.io.texture.pixel_encoding import PixelEncoding
from uplift.io.texture.source import open_image
from uplift.io.texture.uplifter import Uplifter, prepare
from uplift.lights.lookup import load_emission
from uplift.lookup import load

MAX_NAMES = 4
"""Finished textures that an error names."""
DASK_TIMEOUT = "10s"
DASK_CLOSE_SECONDS = 2

T = TypeVar("T")


@dataclass(frozen=True)
class TextureSettings:
    """Settings that all images of a sequence share. They are small enough to send to other processes.

    Parameters
    ----------
    cube : str or None
        Path of the cube, None for the default cube.
    pixel_encoding : PixelEncoding
        Numbers that a pixel holds.
    depth : {"half", "float"} or None
        Type of the channels, None for the default of the pixel encoding.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images.
    threads : int
        Threads per process.
    fill_missing : bool
        Whether to add the nodes that a cube built for a scene lacks (`Cube.fill_missing`).
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1].
    space : str or None
        RGB space of the images, None for the one that each file states.
    """

    cube: str | None
    pixel_encoding: PixelEncoding
    depth: str | None
    encoding: str
    threads: int
    fill_missing: bool = False
    out_of_gamut: str = "clip"
    space: str | None = None

    @property
    def inputs(self) -> tuple[str | None, ...]:
        """Files that the settings name."""
        return (self.cube,)

    def prepare(self) -> Uplifter:
        """Prepare the cube for textures.

        Returns
        -------
        Uplifter
            The converter.
        """
        cube = load(self.cube)
        if self.fill_missing:
            cube = cube.fill_missing(threads=self.threads)
        return prepare(
            cube,
            self.pixel_encoding,
            depth=self.depth,
            encoding=self.encoding,
            out_of_gamut=self.out_of_gamut,
            space=self.space,
            threads=self.threads,
        )


@dataclass(frozen=True)
class LightSettings:
    """Settings that all images of lights in a sequence share.

    Parameters
    ----------
    cube : str or None
        Path of the emission table, None for that of the package.
    wavelengths : tuple of float or None
        Wavelengths of the channels in nm, None for those of the table.
    depth, encoding, threads, space
        As in `TextureSettings`.
    """

    cube: str | None
    wavelengths: tuple[float, ...] | None
    depth: str | None
    encoding: str
    threads: int
    space: str | None = None

    @property
    def inputs(self) -> tuple[str | None, ...]:
        """Files that the settings name."""
        return (self.cube,)

    def prepare(self) -> Converter:
        """Prepare the emission table for textures.

        Returns
        -------
        Converter
            A `LightUplifter`.
        """
        return prepare_lights(
            load_emission(self.cube),
            None if self.wavelengths is None else np.array(self.wavelengths),
            depth=self.depth,
            encoding=self.encoding,
            space=self.space,
            threads=self.threads,
        )


@dataclass(frozen=True)
class MaskedSettings:
    """Settings of images with several cubes.

    Parameters
    ----------
    cubes : tuple of TextureSettings
        Settings of at least two cubes, which differ in the cube only.
    mask : str
        Path of the mask; see `uplift.io.texture.mask`.
    """

    cubes: tuple[TextureSettings, ...]
    mask: str

    @property
    def inputs(self) -> tuple[str | None, ...]:
        """Files that the settings name."""
        return (*(each.cube for each in self.cubes), self.mask)

    def prepare(self) -> Converter:
        """Prepare the cubes for textures.

        Returns
        -------
        Converter
            A `MaskedUplifter`.
        """
        return prepare_masked([each.prepare() for each in self.cubes], Path(self.mask))


Settings = TextureSettings | LightSettings | MaskedSettings


@dataclass(frozen=True)
class Job:
    """The conversion of one image.

    Parameters
    ----------
    settings : TextureSettings, LightSettings or MaskedSettings
        Settings of the sequence.
    source, target : Path
        The image to read and the file to write.
    force : bool
        Whether to replace an existing file.
    """

    settings: Settings
    source: Path
    target: Path
    force: bool = False


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


@lru_cache(maxsize=1)
def converter_for(settings: Settings) -> Converter:
    """Return the converter of the settings, which each process prepares once.

    Parameters
    ----------
    settings : TextureSettings, LightSettings or MaskedSettings
        Settings of the sequence.

    Returns
    -------
    Converter
        The converter.
    """
    return settings.prepare()


def run(job: Job, progress: ProgressCallback = ignore_progress) -> Conversion | Failure:
    """Convert the image of a job. Errors are returned, so that one bad image does not stop the others."""
    try:
        return convert(converter_for(job.settings), job.source, job.target, force=job.force, progress=progress)
    except UpliftError as error:
        return Failure(job.source, error)
    except MemoryError:
        problem, hint = "not enough memory", "use fewer processes"
        return Failure(job.source, TextureError(problem, code="out-of-memory", path=job.source, hint=hint))


def convert_all(jobs: Iterable[Job], executor: Executor) -> Iterator[Conversion | Failure]:
    """Convert images in parallel. Closing the iterator cancels the jobs that have not started.

    Parameters
    ----------
    jobs : iterable of Job
        The images.
    executor : Executor
        Where to run; see `process_executor` and `dask_executor`.

    Yields
    ------
    Conversion or Failure
        Outcomes in order of completion.

    Raises
    ------
    TextureError
        The workers ended before all images were converted (code ``workers-lost``). The error lists the textures that
        are finished; no other file remains.
    """
    jobs = list(jobs)
    futures: dict[Future[Conversion | Failure], Job] = {}
    finished: list[Path] = []
    try:
        futures |= {executor.submit(run, job): job for job in jobs}
        for future in as_completed(futures):
            result = future.result()
            if isinstance(result, Conversion):
                finished.append(result.target)
            yield result
    except Exception as error:
        if not _is_lost(error):
            raise
        if isinstance(error, BrokenExecutor):
            executor.shutdown()  # wait until the workers have closed their files
        raise _workers_lost(jobs, finished) from error
    finally:
        for future in futures:
            future.cancel()


def _is_lost(error: BaseException) -> bool:
    """Return whether an error of an executor means that its workers or its scheduler ended."""
    is_of_dask = type(error).__module__.partition(".")[0] == "distributed"
    return is_of_dask or isinstance(error, BrokenExecutor | CancelledError | TimeoutError)


def _workers_lost(jobs: list[Job], finished: list[Path]) -> TextureError:
    for job in jobs:
        if job.target not in finished:
            with contextlib.suppress(OSError):
                remove_stale(job.target, seconds=0)
    names = ", ".join(target.name for target in finished[:MAX_NAMES])
    more = f" and {len(finished) - MAX_NAMES} more" if len(finished) > MAX_NAMES else ""
    return TextureError(
        f"the workers ended unexpectedly; {len(finished)} of {len(jobs)} textures are finished"
        + (f" ({names}{more})" if finished else ""),
        code="workers-lost",
        hint="resume with the others, with fewer processes if memory ran out",
    )


def pending(jobs: Iterable[Job], *, resume: bool = False) -> list[Job]:
    """Return the jobs that remain, and check that their targets can be written.

    Parameters
    ----------
    jobs : iterable of Job
        All jobs.
    resume : bool
        Whether to leave out images whose textures agree with their checksums, are newer than the image, and of the
        same settings.

    Returns
    -------
    list of Job
        The remaining jobs.

    Raises
    ------
    TextureError
        Two images have the same target (code ``duplicate-target``).
    OutputError
        A target cannot be written, exists, or is an image or the cube of any job.
    """
    jobs = list(jobs)
    for target in {job.target for job in jobs}:
        sources = [os.fspath(job.source) for job in jobs if job.target == target]
        if len(sources) > 1:
            raise TextureError(
                f"every image needs its own target, got {target} for {' and '.join(sources)}",
                code="duplicate-target",
                hint="write them to different folders",
            )
    remaining = [job for job in jobs if not (resume and _is_up_to_date(job))]
    inputs = [path for job in jobs for path in (job.source, *job.settings.inputs)]
    for force in (False, True):
        check_outputs([job.target for job in remaining if job.force == force], inputs=inputs, force=force)
    return remaining


def _is_up_to_date(job: Job) -> bool:
    """Return whether the texture is intact, newer than its image, and of the same cube and settings."""
    try:
        if job.target.stat().st_mtime < job.source.stat().st_mtime:
            return False
    except OSError:
        return False
    header = converter_for(job.settings).header
    try:
        with open_image(job.target) as image:
            equal = all(image.header_text(name) == header[name] for name in ("uplift.cube", "uplift.texture"))
    except TextureError:
        return False
    return equal and exr_file.is_intact(job.target)


@contextlib.contextmanager
def process_executor(count: int) -> Iterator[Executor]:
    """Start processes on this machine; a single one is a thread of the current process.

    The processes end, and remove their unfinished files, when this process ends in any way or the block raises.

    Parameters
    ----------
    count : int
        Number of processes, at least 1.

    Yields
    ------
    Executor
        The executor to pass to `convert_all`.

    Raises
    ------
    OptionError
        The number is below 1 (code ``too-few-processes``).
    """
    if count < 1:
        raise OptionError(
            f"the number of processes must be at least 1, got {count}",
            code="too-few-processes",
            hint="use 1 or more",
        )
    with _OneThread() if count == 1 else tied_processes(count) as pool:
        yield pool


class _OneThread(ThreadPoolExecutor):
    """A thread whose job ends at its next report of progress when the block raises."""

    def __init__(self) -> None:
        super().__init__(1)
        self._is_stopped = threading.Event()

    def submit(self, function: Callable[..., T], /, *args: Any, **options: Any) -> Future[T]:
        """Submit a job that takes ``progress``."""
        return super().submit(function, *args, progress=self._check, **options)

    def __exit__(self, kind: type[BaseException] | None, *rest: Any) -> None:
        """Wait for the running job."""
        if kind is not None:
            self._is_stopped.set()
        super().__exit__(kind, *rest)

    def _check(self, progress: Progress) -> None:
        if self._is_stopped.is_set():
            raise CancelledError


@contextlib.contextmanager
def dask_executor(address: str) -> Iterator[Executor]:
    """Connect to a Dask cluster whose workers share the file system.

    Parameters
    ----------
    address : str
        Address of the scheduler, such as ``tcp://10.0.0.5:8786``.

    Yields
    ------
    Executor
        The executor to pass to `convert_all`.

    Raises
    ------
    OptionError
        Dask is not installed (code ``dask-not-installed``), or no scheduler responds (``dask-unreachable``).
    """
    try:
        import distributed
    except ImportError as error:
        raise OptionError(
            "clusters need Dask, which is not installed",
            code="dask-not-installed",
            hint="install it: pip install 'spectral-uplift[cluster]'",
        ) from error
    with _quiet_dask():
        try:
            client = distributed.Client(address, timeout=DASK_TIMEOUT)
        except Exception as error:  # each protocol has its own, such as RuntimeError for missing certificates
            reason = " ".join(str(error).split())
            raise OptionError(
                f"no Dask scheduler can be used at '{address}'" + (f": {reason}" if reason else ""),
                code="dask-unreachable",
                hint="start one: dask scheduler",
            ) from error
        try:
            yield client.get_executor()
        finally:
            with contextlib.suppress(Exception):  # of a scheduler that has ended
                client.close(timeout=DASK_CLOSE_SECONDS)


@contextlib.contextmanager
def _quiet_dask() -> Iterator[None]:
    """Keep Dask from logging tracebacks of lost connections, which are raised as errors."""
    handlers = {handler: handler.level for handler in logging.getLogger("distributed").handlers}
    for handler in handlers:
        handler.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for handler, level in handlers.items():
            handler.setLevel(level)
