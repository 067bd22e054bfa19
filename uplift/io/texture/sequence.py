"""Many images: each a job of its own, for processes of this machine or those of a Dask cluster."""

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
from uplift.common.files import check_output
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.pixel_encoding import PixelEncoding
from uplift.io.texture.source import open_image
from uplift.io.texture.uplifter import Uplifter, prepare
from uplift.io.texture.writer import is_complete
from uplift.lookup import load


@dataclass(frozen=True)
class TextureSettings:
    """What all images of a sequence are made with: parameters of `load` and of `prepare`, small to send.

    ``fill`` is whether colours outside the scene that the cube was built for are filled in (`Cube.filled`).
    """

    cube: str | None
    form: PixelEncoding
    depth: str | None
    encoding: str
    threads: int
    fill: bool = False
    out_of_gamut: str = "clip"


@dataclass(frozen=True)
class Job:
    """One image."""

    recipe: TextureSettings
    source: Path
    target: Path
    force: bool = False


@dataclass(frozen=True)
class Failure:
    """An image that could not be made, and why."""

    source: Path
    error: UpliftError


@lru_cache(maxsize=1)
def uplifter_for(recipe: TextureSettings) -> Uplifter:
    """The uplifter of a recipe, once a process."""
    cube = load(recipe.cube)
    if recipe.fill:
        cube = cube.fill_missing(threads=recipe.threads)
    return prepare(
        cube,
        recipe.form,
        depth=recipe.depth,
        encoding=recipe.encoding,
        out_of_gamut=recipe.out_of_gamut,
        threads=recipe.threads,
    )


def run(job: Job) -> Conversion | Failure:
    """What became of a job: one bad image stops no others."""
    try:
        return convert(uplifter_for(job.recipe), job.source, job.target, force=job.force)
    except UpliftError as error:
        return Failure(job.source, error)


def convert_all(jobs: Iterable[Job], executor: Executor) -> Iterator[Conversion | Failure]:
    """What became of the jobs, as they are finished; what has not begun is given up with the iterator."""
    futures = [executor.submit(run, job) for job in jobs]
    try:
        for future in as_completed(futures):
            yield future.result()
    finally:
        for future in futures:
            future.cancel()


def pending(jobs: Iterable[Job], *, resume: bool = False) -> list[Job]:
    """Jobs that are still to be done: all, or with ``resume`` those whose textures are not there, whole and newer.

    Asks before long work whether what is to be done can be written. Raises `OutputError`, and `TextureError`
    where two images would have one name.
    """
    jobs = list(jobs)
    for target in {job.target for job in jobs}:
        sources = [os.fspath(job.source) for job in jobs if job.target == target]
        if len(sources) > 1:
            raise TextureError(
                f"{' and '.join(sources)} would both become {target}", hint="write them to two folders"
            )
    todo = [job for job in jobs if not (resume and _is_made(job))]
    for job in todo:
        check_output(job.target, force=job.force)
    return todo


def _is_made(job: Job) -> bool:
    """Whether the texture of a job is there: newer than its image, by the same recipe, and whole."""
    try:
        if job.target.stat().st_mtime < job.source.stat().st_mtime:
            return False
    except OSError:
        return False
    header = uplifter_for(job.recipe).header
    try:
        with open_image(job.target) as image:
            alike = all(image.text(name) == header[name] for name in ("uplift.cube", "uplift.texture"))
    except TextureError:
        return False
    return alike and is_complete(job.target)


@contextlib.contextmanager
def processes(count: int) -> Iterator[Executor]:
    """So many processes of this machine; one is this one. Raises `OptionError`."""
    if count < 1:
        raise OptionError(f"{count} processes cannot work", hint="use 1 or more")
    afresh = multiprocessing.get_context("spawn")  # JAX does not bear being forked
    with ThreadPoolExecutor(1) if count == 1 else ProcessPoolExecutor(count, mp_context=afresh) as pool:
        yield pool


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """The workers of a Dask cluster, which see the same files. Raises `OptionError`."""
    try:
        import distributed
    except ImportError as error:
        raise OptionError(
            "clusters need Dask, which is not installed", hint="install it: pip install 'uplift[cluster]'"
        ) from error
    try:
        client = distributed.Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        problem = f"no Dask scheduler answers at '{address}'"
        raise OptionError(problem, hint="start one: dask scheduler") from error
    with client:
        yield client.get_executor()
