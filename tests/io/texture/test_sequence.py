"""Sequences: over processes, on a cluster, and again where they were left."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from tests.io.texture.conftest import held, planes, write_exr
from uplift.common.errors import OptionError, OutputError, TextureError
from uplift.io import texture
from uplift.io.texture.sequence import run

CUBE = "moments-8-macbeth.uplift"


@pytest.fixture
def recipe(repository):
    return texture.TextureSettings(str(repository / "cubes" / CUBE), texture.Moments(), None, "auto", 1)


@pytest.fixture
def jobs(recipe, colours, tmp_path):
    """Three frames, the second damaged."""
    (tmp_path / "out").mkdir()
    for frame in range(3):
        write_exr(tmp_path / f"shot.{frame}.exr", planes(np.roll(colours, frame, axis=0)))
    (tmp_path / "shot.1.exr").write_text("no image")
    return [
        texture.Job(recipe, tmp_path / f"shot.{frame}.exr", tmp_path / "out" / f"shot.{frame}.exr")
        for frame in range(3)
    ]


def check(jobs, results, small_cube, colours):
    by_name = {result.source.name: result for result in results}
    assert set(by_name) == {job.source.name for job in jobs}
    bad = by_name["shot.1.exr"]
    assert isinstance(bad, texture.Failure)
    assert "shot.1.exr" in str(bad.error)
    assert not jobs[1].target.exists()
    names = [f"moment.{index:02}" for index in range(9)]
    for frame in (0, 2):
        expected = small_cube.coefficients(np.roll(colours, frame, axis=0))
        np.testing.assert_allclose(held(jobs[frame].target, names), expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("count", [1, 2])
def test_processes(count, jobs, small_cube, colours):
    with texture.processes(count) as executor:
        check(jobs, texture.convert_all(jobs, executor), small_cube, colours)


@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster(jobs, small_cube, colours):
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**options) as local, texture.cluster(local.scheduler_address) as executor:
        check(jobs, texture.convert_all(jobs, executor), small_cube, colours)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://"])
def test_no_cluster(address, monkeypatch):
    distributed = pytest.importorskip("distributed")
    client = distributed.Client
    monkeypatch.setattr(distributed, "Client", lambda address, timeout: client(address, timeout="0.2s"))
    with pytest.raises(OptionError, match="no Dask scheduler answers"), texture.cluster(address):
        pass


def test_dask_is_asked_for_where_it_is_missing(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(OptionError, match="not installed; install it"), texture.cluster("tcp://here:1"):
        pass


def test_what_is_there_newer_and_whole_is_left_out(jobs, recipe):
    run(jobs[0])
    target = jobs[0].target
    assert texture.pending([jobs[0]], resume=True) == []
    with pytest.raises(OutputError, match="exists already"):
        texture.pending([jobs[0]])
    forced = [replace(jobs[0], force=True)]
    assert texture.pending(forced, resume=True) == []
    assert texture.pending(forced) == forced

    data = target.read_bytes()
    target.write_bytes(data[:-100])
    assert texture.pending(forced, resume=True) == forced
    target.write_bytes(data)
    assert texture.pending(forced, resume=True) == []

    later = target.stat().st_mtime + 10
    os.utime(jobs[0].source, (later, later))
    assert texture.pending(forced, resume=True) == forced


def test_textures_made_otherwise_are_not_left_out(jobs, recipe):
    run(jobs[0])
    for change in (
        {"depth": "half"},
        {"encoding": "linear"},
        {"form": texture.Multipliers()},
        {"cube": None},
    ):
        other = replace(jobs[0], recipe=replace(recipe, **change), force=True)
        assert texture.pending([other], resume=True) == [other]


def test_two_images_of_one_name_are_refused(jobs):
    twice = [jobs[0], replace(jobs[2], target=jobs[0].target)]
    with pytest.raises(TextureError, match="would both become"):
        texture.pending(twice)


def test_what_has_not_begun_is_given_up(jobs):
    """Whoever stops listening does not pay for the rest."""
    with ThreadPoolExecutor(1) as executor:
        results = texture.convert_all([jobs[0]] * 50, executor)
        next(results)
        results.close()
    assert executor._work_queue.qsize() <= 1


def test_no_processes_cannot_work():
    with pytest.raises(OptionError, match="0 processes"), texture.processes(0):
        pass
