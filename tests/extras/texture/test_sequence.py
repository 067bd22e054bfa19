"""Sequences of images: on processes, on a cluster, and resumed."""

import contextlib
import os
import sys
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, read_channels, write_exr
from tests.helpers import raises
from uplift.common.errors import OptionError, OutputError
from uplift.extras import texture
from uplift.extras.texture.sequence import run


@pytest.fixture
def jobs(repository, colours, tmp_path):
    """Jobs for three frames, the second damaged."""
    cube = str(repository / "cubes" / "moments-8-macbeth.uplift")
    settings = texture.TextureSettings((cube,), texture.Moments(), threads=1)
    (tmp_path / "out").mkdir()
    names = [f"shot.{frame}.exr" for frame in range(3)]
    for frame, name in enumerate(names):
        write_exr(tmp_path / name, planes(np.roll(colours, frame, axis=0)))
    (tmp_path / names[1]).write_text("no image")
    return [
        texture.Job(settings, tmp_path / name, tmp_path / "out" / name)
        for name in names
    ]


@contextlib.contextmanager
def dask_cluster():
    """Address of a cluster of one worker in this process."""
    cluster = pytest.importorskip("distributed").LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    )
    with cluster:
        yield {"scheduler": cluster.scheduler_address}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("workers", ["processes", "dask"])
def test_processes_and_a_dask_cluster(workers, jobs, small_cube, colours):
    two = contextlib.nullcontext({"processes": 2})
    with dask_cluster() if workers == "dask" else two as options:
        results = sorted(
            texture.convert_all(jobs, **options), key=lambda result: result.source
        )
    assert [result.source for result in results] == [job.source for job in jobs]
    assert isinstance(results[1], texture.Failure)
    assert (results[1].error.code, results[1].error.path) == ("texture", jobs[1].source)
    assert not jobs[1].target.exists()
    names = [f"moment.{index:02}" for index in range(9)]
    for frame in (0, 2):
        found = read_channels(jobs[frame].target, names)
        expected = small_cube.coefficients(np.roll(colours, frame, axis=0))
        assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_impossible_workers_raise(monkeypatch):
    with raises(OptionError, "option"):
        list(texture.convert_all([], processes=0))
    monkeypatch.setitem(sys.modules, "distributed", None)
    with raises(OptionError, "extra-not-installed"):
        list(texture.convert_all([], scheduler="tcp://here:1"))


def differs(job):
    """Whether a texture is not that of a job, so that it is replaced only by force."""
    with raises(OutputError, "texture-differs"):
        texture.pending([job])
    forced = replace(job, force=True)
    return texture.pending([forced]) == [forced]


def test_resume_leaves_out_complete_textures(jobs):
    run(jobs[0])
    resumed = replace(jobs[0], resume=True)
    forced = replace(resumed, force=True)
    assert texture.pending([resumed]) == texture.pending([forced]) == []
    assert texture.pending([replace(jobs[0], force=True)])
    with raises(OutputError, "file-exists"):
        texture.pending([jobs[0]])
    data = jobs[0].target.read_bytes()
    changed = bytearray(data)
    changed[len(data) // 2] ^= 1
    for damaged in (data[:-100], changed, b"no texture"):
        jobs[0].target.write_bytes(damaged)
        assert differs(resumed)


def test_textures_of_other_settings_or_images_are_no_textures_to_resume_from(jobs):
    run(jobs[0])
    resumed = replace(jobs[0], resume=True)
    for change in (
        {"depth": "half"},
        {"encoding": "linear"},
        {"pixel_encoding": texture.Multipliers()},
        {"cubes": (None,)},
    ):
        assert differs(replace(resumed, settings=replace(resumed.settings, **change)))
    source = jobs[0].source
    content = source.read_bytes()
    source.write_bytes(jobs[2].source.read_bytes())
    os.utime(source, (0, 0))  # older than the texture
    assert differs(resumed)
    source.write_bytes(content)
    assert texture.pending([resumed]) == []


def test_two_processes_that_resume_at_once_share_the_work(jobs, monkeypatch):
    first, second = (replace(jobs[number], resume=True) for number in (0, 2))
    assert texture.pending([first, second]) == [first, second]
    run(jobs[0])  # by the other process
    assert run(first) == texture.Skipped(first.source)

    def convert(*arguments, **options):
        monkeypatch.undo()
        run(jobs[2])  # as this process begins with the image
        return texture.convert(*arguments, **options)

    monkeypatch.setattr("uplift.extras.texture.sequence.convert", convert)
    assert run(second) == texture.Skipped(second.source)


def test_two_images_with_one_target_raise(jobs):
    with raises(OutputError):
        texture.pending([jobs[0], replace(jobs[2], target=jobs[0].target)])


def test_closing_the_iterator_ends_the_conversions(jobs, tmp_path):
    many = [
        replace(jobs[0], target=tmp_path / "out" / f"{number}.exr")
        for number in range(50)
    ]
    results = texture.convert_all(many, processes=2)
    next(results)
    results.close()
    names = os.listdir(tmp_path / "out")
    assert 1 <= len(names) < 50
    assert all(name.endswith(".exr") for name in names)  # no unfinished file
