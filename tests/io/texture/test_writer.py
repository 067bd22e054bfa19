"""Textures are written completely or not at all."""

from __future__ import annotations

from collections import namedtuple
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from tests.helpers import raises
from tests.io.texture.conftest import planes, write_exr
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


def test_a_disk_that_is_too_small_is_reported_at_the_first_rows(spectral, source, tmp_path, monkeypatch):
    rows = []
    monkeypatch.setattr(writer, "MAX_BAND_BYTES", 1)
    Usage = namedtuple("Usage", "free")
    monkeypatch.setattr("shutil.disk_usage", lambda folder: Usage(2500))
    with raises(OutputError, "not-enough-space") as caught:
        texture.convert(spectral, source, tmp_path / "out.exr", progress=rows.append)
    assert caught.value.path == tmp_path / "out.exr"
    assert rows == []
    assert [path.name for path in tmp_path.iterdir()] == ["in.exr"]
    monkeypatch.setattr("shutil.disk_usage", lambda folder: Usage(20_000))
    texture.convert(spectral, source, tmp_path / "out.exr")
