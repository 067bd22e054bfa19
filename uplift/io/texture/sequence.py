"""Conversion of many images, in the processes of this machine or on a Dask cluster."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from uplift.common.errors import OptionError, TextureError, UpliftError
from uplift.common.files import check_outputs
from uplift.io.texture import exr_file
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.pixel_encoding import PixelEncoding
from uplift.io.texture.source import open_image
from uplift.io.texture.uplifter import Uplifter, prepare
from uplift.lookup import load


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
    """

    cube: str | None
    pixel_encoding: PixelEncoding
    depth: str | None
    encoding: str
    threads: int
    fill_missing: bool = False
    out_of_gamut: str = "clip"


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
    """

    settings: TextureSettings
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
def uplifter_for(settings: TextureSettings) -> Uplifter:
    """Return the uplifter of the settings, which each process prepares once.

    Parameters
    ----------
    settings : TextureSettings
        Settings of the sequence.

    Returns
    -------
    Uplifter
        The converter.
    """
    cube = load(settings.cube)
    if settings.fill_missing:
        cube = cube.fill_missing(threads=settings.threads)
    return prepare(
        cube,
        settings.pixel_encoding,
        depth=settings.depth,
        encoding=settings.encoding,
        out_of_gamut=settings.out_of_gamut,
        threads=settings.threads,
    )


def run(job: Job) -> Conversion | Failure:
    """Convert the image of a job. Errors are returned, so that one bad image does not stop the others."""
    try:
        return convert(uplifter_for(job.settings), job.source, job.target, force=job.force)
    except UpliftError as error:
        return Failure(job.source, error)


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
    """
    futures = [executor.submit(run, job) for job in jobs]
    try:
        for future in as_completed(futures):
            yield future.result()
    finally:
        for future in futures:
            future.cancel()


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
    inputs = [path for job in jobs for path in (job.source, job.settings.cube)]
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
    header = uplifter_for(job.settings).header
    try:
        with open_image(job.target) as image:
            equal = all(image.header_text(name) == header[name] for name in ("uplift.cube", "uplift.texture"))
    except TextureError:
        return False
    return equal and exr_file.is_intact(job.target)


@contextlib.contextmanager
def process_executor(count: int) -> Iterator[Executor]:
    """Start processes on this machine; a single one is a thread of the current process.

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
    spawn = multiprocessing.get_context("spawn")  # JAX cannot be forked
    with ThreadPoolExecutor(1) if count == 1 else ProcessPoolExecutor(count, mp_context=spawn) as pool:
        yield pool


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
            hint="install it: pip install 'uplift[cluster]'",
        ) from error
    try:
        client = distributed.Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        raise OptionError(
            f"no Dask scheduler responds at '{address}'",
            code="dask-unreachable",
            hint="start one: dask scheduler",
        ) from error
    with client:
        yield client.get_executor()
