"""Textures are written completely or not at all, with a checksum; hostile headers are
refused.
"""

import zlib
from collections import namedtuple

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from tests.extras.texture.conftest import planes, write_exr
from tests.extras.texture.exr_bytes import attribute, exr_bytes
from tests.helpers import raises
from uplift.common import machine
from uplift.common.errors import OutputError, TextureError
from uplift.extras import texture
from uplift.extras.images import exr_file, writer
from uplift.extras.images.image import Window, open_image
from uplift.extras.images.writer import OutputPart, open_writer


@pytest.fixture
def source(tmp_path, colours):
    return write_exr(tmp_path / "in.exr", planes(colours))


def test_the_same_image_gives_the_same_bytes(spectral, source, tmp_path, monkeypatch):
    texture.convert(spectral, source, tmp_path / "a.exr")
    monkeypatch.setattr("time.time", lambda: 0.0)
    texture.convert(spectral, source, tmp_path / "b.exr")
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_a_disk_that_is_too_small_is_reported_at_the_first_rows(
    spectral, source, tmp_path, monkeypatch
):
    Usage = namedtuple("Usage", "free")
    target = tmp_path / "out.exr"
    monkeypatch.setattr(writer, "MAX_BAND_BYTES", 1)
    monkeypatch.setattr("shutil.disk_usage", lambda folder: Usage(2500))
    with raises(OutputError, "not-enough-space") as caught:
        texture.convert(spectral, source, target, progress=pytest.fail)
    assert caught.value.path == target
    assert list(tmp_path.iterdir()) == [source]
    monkeypatch.setattr("shutil.disk_usage", lambda folder: Usage(20_000))
    texture.convert(spectral, source, target)


def half(data):
    return data[: len(data) // 2]


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("in.exr", half),
        ("in.png", half),
        ("in.jpg", half),
        ("in.tif", half),
        ("in.png", lambda data: data.replace(b"IDAT", b"XDAT")),
        ("in.png", lambda data: data[:60] + data[60:].swapcase()),
    ],
)
def test_a_damaged_image_raises_and_leaves_nothing(
    name, change, spectral, source, colours, tmp_path, capfd
):
    if name != "in.exr":
        source.unlink()
        source = tmp_path / name
        codes = (255 * np.tile(colours, (4, 4, 1))).astype(np.uint8)
        Image.fromarray(codes).save(source)
    source.write_bytes(change(source.read_bytes()))
    with raises(TextureError, "file-unreadable") as caught:
        texture.convert(spectral, source, tmp_path / "out.exr")
    assert caught.value.path == source
    assert list(tmp_path.iterdir()) == [source]
    assert capfd.readouterr() == ("", "")  # nor does a library print


def test_an_interruption_leaves_nothing(spectral, source, tmp_path):
    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        texture.convert(spectral, source, tmp_path / "out.exr", progress=stop)
    assert list(tmp_path.iterdir()) == [source]


HEIGHT = 50
WIDTH = 40


def write_parts(path, count, rows=HEIGHT):
    """Write parts of noise, which ZIP stores as it is, and zeros, and only some rows of
    the last part.
    """
    window = Window(0, 0, WIDTH, HEIGHT, (0, 0, WIDTH, HEIGHT), 1.0)
    names = ["left", "right"] if count > 1 else [""]
    parts = [
        OutputPart(name, window, ("Z",), ("float",), {}, "2000:01:01 00:00:00")
        for name in names
    ]
    values = np.random.default_rng(0).random((HEIGHT, WIDTH, 1), dtype=np.float32)
    values[32:] = 0
    with open_writer(path, parts) as opened:
        for number in range(count):
            opened.start_part(number)
            opened.write_rows(0, values[:rows])


@pytest.mark.parametrize("count", [1, 2])
def test_the_checksum_is_that_of_the_bytes_and_finds_every_change(count, tmp_path):
    path = tmp_path / "a.exr"
    write_parts(path, count)
    stored = OpenEXR.File(str(path)).parts[0].header[exr_file.CHECKSUM]
    data = path.read_bytes()
    assert data.count(stored.encode()) == 1
    assert f"{zlib.crc32(data.replace(stored.encode(), b'0' * 8)):08x}" == stored
    assert exr_file.is_intact(path)
    for place in np.linspace(0, len(data) - 1, 60).astype(int):
        damaged = bytearray(data)
        damaged[place] ^= 1
        path.write_bytes(damaged)
        assert not exr_file.is_intact(path), place
    for other in (b"", data[:4], half(data), data[:-1], data + b"\0"):
        path.write_bytes(other)
        assert not exr_file.is_intact(path)


def test_a_missing_chunk_is_an_incomplete_file(tmp_path):
    with raises(OutputError) as caught:
        write_parts(tmp_path / "a.exr", 1, rows=16)
    assert caught.value.path == tmp_path / "a.exr"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("count", [1021, 1022])
def test_too_many_channels_are_refused_before_the_work(
    count, source, small_cube, tmp_path
):
    wavelengths = tuple(np.linspace(400, 700, count))
    made = texture.prepare(small_cube, texture.Spectrum(wavelengths))
    if count == 1021:
        texture.convert(made, source, tmp_path / "out.exr")
        return
    with raises(OutputError, "too-many-channels"):
        texture.convert(made, source, tmp_path / "out.exr", progress=pytest.fail)


def many(count):
    return [b"c%06d" % number for number in range(count)]


LARGE = attribute(b"a", b"int", b"")[:-4] + b"\xff\xff\xff\x7f"
ATTRIBUTES = b"".join(attribute(name, b"int", bytes(4)) for name in many(200_000))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (exr_bytes(many(1_000_000)), "texture"),
        (exr_bytes(many(exr_file.MAX_CHANNELS + 1)), "texture"),
        (exr_bytes(extra=ATTRIBUTES), "texture"),
        (exr_bytes([b"B", b"G", b"R", b"\xff\xfe"]), "texture"),
        (exr_bytes()[:60], "file-unreadable"),
        (exr_bytes(extra=b"a" * 300), "file-unreadable"),
        (exr_bytes(extra=LARGE), "file-unreadable"),
        (exr_bytes([b"B", b"G", b"R", *many(exr_file.MAX_CHANNELS - 3)]), None),
        (exr_bytes(extra=attribute(b"capDate", b"string", b"\xff\xfe")), None),
        (exr_bytes(extra=attribute(b"chromaticities", b"string", b"abc")), None),
    ],
)
def test_hostile_headers_are_refused_and_odd_ones_are_read(content, code, tmp_path):
    path = tmp_path / "a.exr"
    path.write_bytes(content)
    if code is None:
        with open_image(path) as image:
            assert {"R", "G", "B"} <= set(image.parts[0].channels)
        return
    with raises(TextureError, code) as caught, open_image(path):
        pass
    assert caught.value.path == path


def test_blocks_that_do_not_fit_into_memory_are_refused(tmp_path, monkeypatch):
    (tmp_path / "a.exr").write_bytes(exr_bytes())
    monkeypatch.setattr(machine, "free_memory", lambda: 4 * 3 * 5 - 1)
    with raises(TextureError, "out-of-memory"), open_image(tmp_path / "a.exr"):
        pass
    monkeypatch.setattr(machine, "free_memory", lambda: 4 * 3 * 5)
    with open_image(tmp_path / "a.exr"):
        pass


def test_files_of_no_known_format_are_not_tried_by_all_decoders(tmp_path):
    with (tmp_path / "a.exr").open("wb") as file:
        file.truncate(20 << 30)  # sparse
    with raises(TextureError, "texture"), open_image(tmp_path / "a.exr"):
        pass
