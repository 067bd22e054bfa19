"""Headers that would take minutes are refused; missing chunks and any changed byte are found."""

from __future__ import annotations

import numpy as np
import OpenEXR
import pytest

from tests.helpers import raises
from tests.io.texture.exr_bytes import attribute, exr_bytes
from uplift.common.errors import OutputError, TextureError
from uplift.io.texture import exr_file
from uplift.io.texture.image import Window, open_image
from uplift.io.texture.writer import OutputPart, open_writer

HEIGHT, WIDTH = 50, 40


@pytest.fixture(params=[1, 2])
def written(request, tmp_path):
    """A texture of one or two parts, of noise, which ZIP stores as it is, and zeros."""
    window = Window(0, 0, WIDTH, HEIGHT, (0, 0, WIDTH, HEIGHT), 1.0)
    names = [f"part {number}" if request.param > 1 else "" for number in range(request.param)]
    parts = [OutputPart(name, window, ("Z",), ("float",), {}, "2000:01:01 00:00:00") for name in names]
    with open_writer(tmp_path / "a.exr", parts) as writer:
        for number in range(request.param):
            writer.start_part(number)
            noise = np.random.default_rng(number).random((32, WIDTH, 1), dtype=np.float32)
            writer.write_rows(0, noise)
            writer.write_rows(32, np.zeros((HEIGHT - 32, WIDTH, 1), np.float32))
    return tmp_path / "a.exr"


def test_the_checksum_is_that_of_the_bytes(written):
    import zlib

    path = written
    stored = OpenEXR.File(str(path)).parts[0].header[exr_file.CHECKSUM]
    data = path.read_bytes()
    assert data.count(stored.encode()) == 1
    assert f"{zlib.crc32(data.replace(stored.encode(), b'0' * 8)):08x}" == stored
    assert exr_file.is_intact(path)


def test_every_changed_byte_is_found(written):
    path = written
    data = path.read_bytes()
    for place in np.linspace(0, len(data) - 1, 60).astype(int):
        path.write_bytes(data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :])
        assert not exr_file.is_intact(path), place


def test_truncated_files_are_not_intact(written):
    data = written.read_bytes()
    for changed in (b"", data[:4], data[:100], data[: len(data) // 2], data[:-1], data + b"\0"):
        written.write_bytes(changed)
        assert not exr_file.is_intact(written)
    assert not exr_file.is_intact(written.parent / "none.exr")


def test_a_missing_chunk_is_an_incomplete_file(tmp_path):
    window = Window(0, 0, WIDTH, HEIGHT, (0, 0, WIDTH, HEIGHT), 1.0)
    part = OutputPart("", window, ("Z",), ("float",), {}, "2000:01:01 00:00:00")
    with raises(OutputError) as caught, open_writer(tmp_path / "a.exr", [part]) as writer:
        writer.start_part(0)
        writer.write_rows(0, np.zeros((16, WIDTH, 1), np.float32))
    assert caught.value.path == tmp_path / "a.exr"
    assert list(tmp_path.iterdir()) == []


def many(count):
    return b"".join(attribute(b"a%06d" % number, b"int", bytes(4)) for number in range(count))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (exr_bytes([b"c%06d" % number for number in range(1_000_000)]), "texture"),
        (exr_bytes([b"c%06d" % number for number in range(exr_file.MAX_CHANNELS + 1)]), "texture"),
        (exr_bytes(extra=many(200_000)), "texture"),
        (exr_bytes([b"B", b"G", b"R", b"\xff\xfe"]), "texture"),
        (exr_bytes()[:60], "damaged-image"),
        (exr_bytes(extra=b"a" * 300), "damaged-image"),
        (exr_bytes(extra=attribute(b"a", b"int", b"")[:-4] + b"\xff\xff\xff\x7f"), "damaged-image"),
        (exr_bytes(extra=attribute(b"a", b"int", b"")[:-4] + b"\xff\xff\xff\xff"), "damaged-image"),
    ],
)
def test_hostile_headers_are_refused(content, code, tmp_path):
    (tmp_path / "a.exr").write_bytes(content)
    with raises(TextureError, code) as caught, open_image(tmp_path / "a.exr"):
        pass
    assert caught.value.path == tmp_path / "a.exr"


@pytest.mark.parametrize(
    "content",
    [
        exr_bytes([b"B", b"G", b"R", *(b"c%06d" % number for number in range(exr_file.MAX_CHANNELS - 3))]),
        exr_bytes(extra=attribute(b"capDate", b"string", b"\xff\xfe")),
        exr_bytes(extra=attribute(b"chromaticities", b"string", b"abc")),
    ],
)
def test_odd_headers_are_read(content, tmp_path):
    (tmp_path / "a.exr").write_bytes(content)
    with open_image(tmp_path / "a.exr") as image:
        assert {"R", "G", "B"} <= set(image.parts[0].channels)
        assert image.parts[0].date is None


def test_blocks_that_do_not_fit_into_memory_are_refused(tmp_path, monkeypatch):
    from uplift.io.texture import image as source

    (tmp_path / "a.exr").write_bytes(exr_bytes())
    monkeypatch.setattr(source, "total_memory", lambda: 4 * 3 * 5 - 1)
    with raises(TextureError), open_image(tmp_path / "a.exr"):
        pass
    monkeypatch.setattr(source, "total_memory", lambda: 4 * 3 * 5)
    with open_image(tmp_path / "a.exr"):
        pass
