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


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("workers", [1, 2, "dask"])
def test_processes_and_a_dask_cluster(workers, jobs, small_cube, colours):
    with contextlib.ExitStack() as stack:
        options = {"processes": workers}
        if workers == "dask":
            settings = {
                "n_workers": 1,
                "threads_per_worker": 1,
                "processes": False,
                "dashboard_address": None,
            }
            cluster = pytest.importorskip("distributed").LocalCluster(**settings)
            options = {"scheduler": stack.enter_context(cluster).scheduler_address}
        results = sorted(
            texture.convert_all(jobs, **options), key=lambda result: result.source
        )
    assert [result.source for result in results] == [job.source for job in jobs]
    assert isinstance(results[1], texture.Failure)
    assert (results[1].error.code, results[1].error.path) == ("texture", jobs[1].source)
    assert not jobs[1].target.exists()
    names = [f"moment.{index:02}" for index in range(9)]
    for frame in (0, 2):
        expected = small_cube.coefficients(np.roll(colours, frame, axis=0))
        assert_allclose(
            read_channels(jobs[frame].target, names), expected, rtol=0, atol=1e-6
        )


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"processes": 0}, "option"),
        ({"scheduler": "tcp://127.0.0.1:1"}, "option"),
        ({"scheduler": "nonsense://"}, "option"),
    ],
)
def test_impossible_workers_raise(options, code, monkeypatch):
    distributed = pytest.importorskip("distributed")
    client = distributed.Client
    monkeypatch.setattr(
        distributed, "Client", lambda address, timeout: client(address, timeout="0.2s")
    )
    with raises(OptionError, code):
        list(texture.convert_all([], **options))


def test_missing_dask_raises(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with raises(OptionError, "extra-not-installed"):
        list(texture.convert_all([], scheduler="tcp://here:1"))


def test_resume_leaves_out_complete_textures(jobs):
    run(jobs[0])
    target = jobs[0].target
    resumed = replace(jobs[0], resume=True)
    forced = replace(resumed, force=True)
    assert texture.pending([resumed]) == texture.pending([forced]) == []
    assert texture.pending([replace(jobs[0], force=True)])
    with raises(OutputError, "file-exists"):
        texture.pending([jobs[0]])

    data = target.read_bytes()
    middle = bytes([data[len(data) // 2] ^ 1])
    for damaged in (
        data[:-100],
        data[: len(data) // 2] + middle + data[len(data) // 2 + 1 :],
        b"no texture",
    ):
        target.write_bytes(damaged)
        with raises(OutputError, "texture-differs"):
            texture.pending([resumed])
        assert texture.pending([forced]) == [forced]


@pytest.mark.parametrize(
    "change",
    [
        {"depth": "half"},
        {"encoding": "linear"},
        {"pixel_encoding": texture.Multipliers()},
        {"cubes": (None,)},
    ],
)
def test_textures_of_other_settings_are_no_textures_to_resume_from(jobs, change):
    run(jobs[0])
    other = replace(jobs[0], settings=replace(jobs[0].settings, **change), resume=True)
    with raises(OutputError, "texture-differs"):
        texture.pending([other])
    assert len(texture.pending([replace(other, force=True)])) == 1


def test_an_image_that_an_older_one_has_replaced_is_converted_again(jobs):
    run(jobs[0])
    resumed = replace(jobs[0], resume=True)
    content = jobs[0].source.read_bytes()
    jobs[0].source.write_bytes(jobs[2].source.read_bytes())
    os.utime(jobs[0].source, (0, 0))
    with raises(OutputError, "texture-differs"):
        texture.pending([resumed])
    jobs[0].source.write_bytes(content)  # newer than the texture
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


@pytest.mark.parametrize("count", [1, 2])
def test_closing_the_iterator_ends_the_conversions(jobs, count, tmp_path):
    many = [
        replace(jobs[0], target=tmp_path / "out" / f"{number}.exr")
        for number in range(50)
    ]
    results = texture.convert_all(many, processes=count)
    next(results)
    results.close()
    names = os.listdir(tmp_path / "out")
    assert 1 <= len(names) < 50
    assert all(name.endswith(".exr") for name in names)  # no unfinished file
