"""Textures are written completely or not at all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from tests.helpers import raises
from tests.io.texture.conftest import planes, small_tiles, write_exr
from uplift.common.errors import OutputError, TextureError
from uplift.io import texture
from uplift.io.texture import writer


@pytest.fixture
def source(tmp_path, colours):
    return write_exr(tmp_path / "in.exr", planes(colours))


def test_the_same_image_gives_the_same_bytes(spectral, source, tmp_path, monkeypatch):
    texture.convert(spectral, source, tmp_path / "a.exr")
    monkeypatch.setattr("time.time", lambda: 0.0)
    texture.convert(spectral, source, tmp_path / "b.exr")
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_an_existing_file_is_replaced_only_with_force(spectral, source, tmp_path):
    (tmp_path / "out.exr").write_text("old")
    with raises(OutputError, "file-exists"):
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert (tmp_path / "out.exr").read_text() == "old"
    texture.convert(spectral, source, tmp_path / "out.exr", force=True)
    assert OpenEXR.isOpenExrFile(str(tmp_path / "out.exr"))


def test_a_full_disk_leaves_nothing(spectral, source, tmp_path, monkeypatch):
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("no /dev/full here")
    original = writer.Writer
    monkeypatch.setattr(writer, "Writer", lambda path, parts: original(full, parts))
    with pytest.raises(OutputError):
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert [path.name for path in tmp_path.iterdir()] == ["in.exr"]


@pytest.mark.parametrize("name", ["in.exr", "in.png", "in.jpg", "in.tif"])
def test_a_damaged_image_raises_and_leaves_nothing(name, spectral, source, colours, tmp_path):
    if name != "in.exr":
        source.unlink()
        source = tmp_path / name
        Image.fromarray((255 * np.tile(colours, (4, 4, 1))).astype(np.uint8)).save(source)
    data = source.read_bytes()
    source.write_bytes(data[: len(data) // 2])
    with pytest.raises(TextureError) as caught:
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert caught.value.code in ("damaged-image", "unreadable-image")
    assert caught.value.path == source
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_an_interruption_leaves_nothing(spectral, source, tmp_path):
    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        texture.convert(spectral, source, tmp_path / "out.exr", progress=stop)
    assert [path.name for path in tmp_path.iterdir()] == ["in.exr"]


@pytest.mark.parametrize("kind", [OpenEXR.scanlineimage, OpenEXR.tiledimage])
def test_truncated_files_are_incomplete(kind, tmp_path):
    plane = np.random.default_rng(0).random((50, 60)).astype(np.float32)
    tiles = {"tiles": small_tiles()} if kind == OpenEXR.tiledimage else {}
    header = {"type": kind, **tiles}
    parts = [OpenEXR.Part({**header}, {"Z": plane}, "a"), OpenEXR.Part({**header}, {"Z": plane}, "b")]
    OpenEXR.File(parts).write(str(tmp_path / "complete.exr"))
    data = (tmp_path / "complete.exr").read_bytes()
    assert writer.is_complete(tmp_path / "complete.exr")
    for share in (0, 0.01, 0.3, 0.6, 0.99):
        (tmp_path / "cut.exr").write_bytes(data[: int(share * len(data))])
        assert not writer.is_complete(tmp_path / "cut.exr"), share
    assert not writer.is_complete(tmp_path / "none.exr")
