"""Conversion of images: decoding, gamut mapping, alpha, channels that pass through;
reduced pictures.
"""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tests.extras.texture.conftest import (
    WAVELENGTHS,
    channels,
    planes,
    read_channels,
    rgb_of,
    small_tiles,
    write_exr,
    write_image,
)
from tests.helpers import raises
from uplift.colorimetry.gamut import map_to_gamut
from uplift.common.errors import ColourError, TextureError
from uplift.cube.data import EntrySpectra
from uplift.extras import texture
from uplift.extras.colour.spaces import find_space
from uplift.extras.images.image import open_image
from uplift.extras.images.picture import read_picture
from uplift.extras.mitsuba.texels import read_colours
from uplift.extras.texture.scene_colours import Images
from uplift.models.model import evaluate


@pytest.mark.parametrize(("suffix", "count"), [("png", 2), ("png", 4), ("tif", 4)])
@pytest.mark.parametrize("dtype", ["uint8", "uint16"])
def test_straight_alpha_of_integers_passes_through(
    suffix, count, dtype, to_texture, tmp_path
):
    """`tests.fuzz.images` has the colours."""
    top = np.iinfo(dtype).max
    codes = np.random.default_rng(1).integers(
        0, top, (12, 17, count), dtype=dtype, endpoint=True
    )
    path = tmp_path / f"a.{suffix}"
    write_image(path, codes, **{"oiio:UnassociatedAlpha": 1})
    alpha = channels(to_texture(path).target)["A"] * float(top)
    assert_array_equal(np.rint(alpha), codes[..., -1])


def test_floats_are_linear_unless_the_encoding_is_given(
    colours, to_texture, small_cube, tmp_path
):
    Image.fromarray(colours[..., 0]).save(tmp_path / "float.tif")
    grey = rgb_of(to_texture(tmp_path / "float.tif"))[..., 0]
    assert_array_equal(grey, colours[..., 0])
    encoded = texture.prepare(
        small_cube, texture.Moments(), encoding="encoded", threads=1
    )
    grey = rgb_of(to_texture(tmp_path / "float.tif", encoded))[..., 0]
    assert_allclose(grey, small_cube.decode(255.0 * colours[..., 0]), rtol=0, atol=1e-6)
    codes = (colours * 255).astype(np.uint8)
    Image.fromarray(codes).save(tmp_path / "linear.png")
    linear = texture.prepare(
        small_cube, texture.Moments(), encoding="linear", threads=1
    )
    result = to_texture(tmp_path / "linear.png", linear)
    assert_allclose(rgb_of(result), codes / 255, rtol=0, atol=1e-7)


UPRIGHT = np.arange(24, dtype=np.uint8).reshape(4, 6) * 10
STORED = [
    *(UPRIGHT, UPRIGHT[:, ::-1], UPRIGHT[::-1, ::-1], UPRIGHT[::-1]),
    *(UPRIGHT.T, UPRIGHT.T[::-1], UPRIGHT.T[::-1, ::-1], UPRIGHT.T[:, ::-1]),
]
"""Rows of files by orientation, from 1 (EXIF 2.32, 4.6.4)."""
HDR_AXES = ("-Y +X", "-Y -X", "+Y -X", "+Y +X", "+X -Y", "-X -Y", "-X +Y", "+X +Y")


@pytest.mark.parametrize("number", range(8))
@pytest.mark.parametrize("suffix", ["jpg", "png", "tif", "hdr"])
def test_images_are_upright(suffix, number, tmp_path):
    path = tmp_path / f"photo.{suffix}"
    stored = np.repeat(STORED[number][..., None], 3, axis=2)
    write_image(path, stored, Orientation=1 + number)
    if suffix == "hdr":
        size = "{0} {2} {1} {3}".format(*HDR_AXES[number].split(), *stored.shape)
        head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n"
        pixels = np.insert(stored, 3, 136, axis=2)
        path.write_bytes(head.encode() + pixels.tobytes())
    with open_image(path) as image:
        (part,) = image.parts
        rows = np.concatenate([band for _, band in image.bands(part)])
    assert_allclose(rows[..., 0], UPRIGHT, atol=8)
    assert (part.window.height, part.window.width) == UPRIGHT.shape


@pytest.mark.parametrize("name", ["T.550,000000nm", "S0.550,5nm", "moment.03", "T.x"])
def test_spectra_that_are_not_used_are_stated(name, sensor, tmp_path):
    content = planes(np.full((2, 2, 3), 0.5, np.float32))
    path = write_exr(tmp_path / "a.exr", content | {name: content["R"]})
    codes = [
        warning.code for warning in read_picture(path, sensor, max_side=9).warnings
    ]
    assert codes == ["spectra-not-used"] * (name != "T.x")


def mapping(uplifter, method):
    """Return the same uplifter with another gamut mapping."""
    return replace(uplifter, reader=replace(uplifter.reader, out_of_gamut=method))


@pytest.mark.parametrize("method", ["clip", "scale", "desaturate", "desaturate-oklab"])
def test_only_invalid_pixels_are_mapped_and_counted(
    method, colours, to_texture, spectral, tmp_path
):
    bad = colours.copy()
    bad[3, :5] = np.array(
        [[-0.25, 0.5, 2], [8, 4, 1], [0.2, 0.6, -0.1], [-1, -1, -1], [7, 7, 7]]
    )
    bad[4, 4] = (np.inf, 5, np.nan)
    bad[4, 5] = np.nan
    result = to_texture(planes(bad), mapping(spectral, method))
    bad[4, 4] = (1, 1, 0)
    bad[4, 5] = 0
    mapped = map_to_gamut(bad, spectral.cube.data.sensor, method)
    assert_array_equal(rgb_of(result), mapped.rgb)
    assert result.counts.pixels == 600
    assert result.counts["pixels-not-finite"] == 2
    outside = result.counts.changes["pixels-out-of-gamut"]
    assert (outside.pixels, outside.largest) == (5, mapped.max_change)
    assert [warning.code for warning in result.warnings] == [
        "pixels-out-of-gamut",
        "pixels-not-finite",
    ]
    assert [warning.path for warning in result.warnings] == [result.source] * 2
    spectra = read_channels(result.target, spectral.channels)
    assert_allclose(
        spectra, spectral.cube.reflectance(mapped.rgb, WAVELENGTHS), atol=1e-6
    )


@pytest.mark.parametrize("bad", [1.5, -0.5, np.nan])
def test_pixels_outside_can_be_an_error(bad, colours, spectral, to_texture, tmp_path):
    strict = mapping(spectral, "error")
    to_texture(planes(colours), strict)
    rgb = colours.copy()
    rgb[3, 3, 0] = bad
    source = write_exr(tmp_path / "bad.exr", planes(rgb))
    with raises(
        ColourError, "colour" if np.isnan(bad) else "rgb-out-of-gamut"
    ) as caught:
        texture.convert(strict, source, tmp_path / "bad-out.exr")
    assert caught.value.path == source
    assert f"({bad:g}, " in caught.value.problem
    assert not (tmp_path / "bad-out.exr").exists()


@pytest.mark.parametrize("kind", [OpenEXR.scanlineimage, OpenEXR.tiledimage])
@pytest.mark.parametrize("band", [1, 1 << 25])
def test_several_parts_tiles_windows_and_other_channels(
    kind, band, spectral, to_texture, tmp_path, monkeypatch
):
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    shape = (70, 45)
    rng = np.random.default_rng(2)
    rgb = rng.random((*shape, 3)).astype(np.float16)
    depth = rng.normal(0, 1e6, shape).astype(np.float32)
    depth[0, :3] = (np.nan, np.inf, -np.inf)
    ids = rng.integers(0, 1 << 24, shape, dtype=np.uint32, endpoint=True)
    mask = rng.random(shape).astype(np.float16)
    others: dict[str, np.ndarray] = {"mask": mask, "Z": depth, "id": ids}
    header = {
        "type": kind,
        "dataWindow": ((5, -7), (5 + shape[1] - 1, -7 + shape[0] - 1)),
        "displayWindow": ((0, 0), (99, 79)),
        "pixelAspectRatio": 2.0,
        **({"tiles": small_tiles()} if kind == OpenEXR.tiledimage else {}),
    }
    parts = [
        OpenEXR.Part({**header}, {**planes(rgb), **others}, "left"),
        OpenEXR.Part({**header}, {"deep.Z": depth}, "depth"),
        OpenEXR.Part(
            {**header},
            {f"view.{name}": plane for name, plane in planes(rgb[::-1]).items()},
            "right",
        ),
    ]
    OpenEXR.File(parts).write(str(tmp_path / "in.exr"))
    result = to_texture(tmp_path / "in.exr")
    assert result.counts.pixels == 2 * rgb.size // 3
    written = OpenEXR.File(str(result.target), separate_channels=True).parts
    assert [part.name() for part in written] == ["left", "depth", "right"]
    for part in written:
        assert_array_equal(part.header["dataWindow"], [[5, -7], [49, 62]])
        assert_array_equal(part.header["displayWindow"], [[0, 0], [99, 79]])
        assert part.header["pixelAspectRatio"] == 2
    for name, plane in others.items():
        assert written[0].channels[name].pixels.dtype == plane.dtype
        assert_array_equal(written[0].channels[name].pixels, plane)
    assert set(written[1].channels) == {"deep.Z"}
    for number, colours in ((0, rgb), (2, rgb[::-1])):
        found = read_channels(result.target, spectral.channels, number)
        assert_allclose(
            found, spectral.cube.reflectance(colours, WAVELENGTHS), rtol=0, atol=1e-6
        )


ZERO = np.zeros((4, 5), np.float32)
RGB = dict.fromkeys("RGB", ZERO)


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("none.png", None, "file-not-found"),
        (".", None, "file-unreadable"),
        ("text.png", "no image", "texture"),
        ("a.bmp", Image.new("RGB", (5, 4)), "texture"),
        ("depth.exr", {"Z": ZERO}, "texture"),
        (
            "layers.exr",
            dict.fromkeys(("a.R", "a.G", "a.B", "b.R", "b.G", "b.B"), ZERO),
            "texture",
        ),
        ("integers.exr", dict.fromkeys("RGB", ZERO.astype(np.uint32)), "texture"),
        (
            "float32-cannot-hold.exr",
            {**RGB, "id": np.full((4, 5), (1 << 24) + 1, np.uint32)},
            "texture",
        ),
        ("spectral.exr", {**RGB, "T.400,000000nm": ZERO}, "texture"),
    ],
)
def test_unusable_images_are_refused(name, content, code, to_texture, tmp_path):
    path = tmp_path / name
    if isinstance(content, str):
        path.write_text(content)
    elif isinstance(content, dict):
        write_exr(path, content)
    elif content is not None:
        content.save(path)
    with raises(TextureError, code) as caught:
        to_texture(path)
    assert caught.value.path == path
    assert not (tmp_path / "out.exr").exists()


STATEMENTS = {
    "owner": ("string", "a studio"),
    "crew": ("string[2]", ("Ann", "Bo")),
    "framesPerSecond": ("rational", (24000, 1001)),
    "smpte:TimeCode": ("timecode", (0x01020304, 0)),
    "smpte:KeyCode": ("keycode", (1, 2, 3, 4, 5, 4, 64)),
    "worldToCamera": ("matrix", tuple(range(16))),
    "focus": ("float", 1.5),
    "take": ("int", 3),
    "screenWindowCenter": ("float[2]", (0.25, 0.5)),
    "colorInteropID": ("string", "lin_rec709_scene"),
}


def test_statements_of_the_image_are_kept(to_texture, tmp_path):
    typed = {
        name: (OpenImageIO.TypeDesc(kind), value)
        for name, (kind, value) in STATEMENTS.items()
    }
    write_image(tmp_path / "a.exr", np.zeros((3, 4, 3), np.float32), **typed)
    result = to_texture(tmp_path / "a.exr")
    before = OpenEXR.File(str(result.source)).header()
    after = OpenEXR.File(str(result.target)).header()
    assert before.keys() - after.keys() == {"colorInteropID"}
    assert before["framesPerSecond"] == Fraction(24000, 1001)
    for name in ("timeCode", "keyCode", *(STATEMENTS.keys() & after.keys())):
        assert_array_equal(after[name], before[name], err_msg=name)


@pytest.fixture
def alpha(colours):
    """Alpha (20, 30), with 0 and 1."""
    values = np.random.default_rng(4).random(colours.shape[:2]).astype(np.float32)
    values[:, :2] = [0, 1]
    return values


@pytest.fixture
def multiplied(colours, alpha, tmp_path):
    """OpenEXR file of colours multiplied by alpha."""
    return write_exr(
        tmp_path / "in.exr", {**planes(colours * alpha[..., None]), "A": alpha}
    )


@pytest.mark.parametrize("layer", ["", "view."])
def test_spectra_are_those_of_the_divided_colours_times_alpha(
    layer, colours, alpha, spectral, to_texture
):
    shown = {
        f"{layer}{name}": plane
        for name, plane in {**planes(colours * alpha[..., None]), "A": alpha}.items()
    }
    other = {"A": np.zeros_like(alpha)} if layer else {}
    result = to_texture({**other, **shown})
    found = read_channels(result.target, spectral.channels)
    expected = (
        spectral.cube.reflectance(colours.astype(float), WAVELENGTHS) * alpha[..., None]
    )
    assert_allclose(found, expected, rtol=0, atol=2e-6)
    rgb = rgb_of(result)
    assert_allclose(rgb, colours * alpha[..., None], rtol=0, atol=1e-6)
    assert_array_equal(channels(result.target)[f"{layer}A"], alpha)
    assert (found[:, 0] == 0).all()
    assert result.warnings == ()


def test_moments_are_multiplied_and_multipliers_are_not(
    multiplied, colours, alpha, small_cube, to_texture, tmp_path
):
    solid = write_exr(tmp_path / "solid.exr", planes(colours))
    for encoding, weight in (
        (texture.Moments(), alpha),
        (texture.Multipliers(), np.where(alpha > 0, 1, 0)),
    ):
        uplifter = texture.prepare(small_cube, encoding, threads=1)
        numbers = []
        for source in (solid, multiplied):
            to_texture(source, uplifter)
            numbers.append(read_channels(tmp_path / "out.exr", uplifter.channels))
        visible = alpha > 1e-3
        expected = numbers[0] * weight[..., None]
        assert_allclose(numbers[1][visible], expected[visible], rtol=1e-3, atol=2e-3)


@pytest.mark.parametrize("is_multiplied", [True, False])
def test_tiffs_state_whether_they_are_multiplied(
    is_multiplied, small_cube, to_texture, tmp_path
):
    codes = np.array(
        [[[100, 50, 0, 200], [200, 200, 200, 200], [0, 0, 0, 0], [9, 0, 0, 0]]],
        np.uint8,
    )
    write_image(
        tmp_path / "a.tif", codes, **{"oiio:UnassociatedAlpha": int(not is_multiplied)}
    )
    result = to_texture(tmp_path / "a.tif")
    found = rgb_of(result)[0]
    straight = codes[0, :, :3].astype(float)
    expected = small_cube.decode(straight)
    if is_multiplied:
        expected = small_cube.decode(np.rint(straight[:2] * 255 / 200)) * 200 / 255
        expected = np.concatenate([expected, small_cube.decode(straight[2:])])
    assert_allclose(found, expected, rtol=0, atol=1e-6)
    assert_array_equal(np.rint(channels(result.target)["A"][0] * 255.0), codes[0, :, 3])


def test_half_floats_leave_the_unit_interval_by_rounding_only(to_texture):
    alpha = np.linspace(0.01, 1, 600).reshape(20, 30)
    white = np.repeat(alpha[..., None] * (1 + 1e-4), 3, axis=-1).astype(np.float16)
    assert to_texture({**planes(white), "A": alpha.astype(np.float16)}).warnings == ()


def test_odd_alpha_gives_finite_colours_and_warnings(spectral, to_texture):
    alpha = np.array([[0, np.nan, np.inf, 2, -1, 0.5]], np.float32)
    result = to_texture({**planes(np.full((1, 6, 3), 0.75, np.float32)), "A": alpha})
    assert {each.code for each in result.warnings} == {
        "pixels-not-finite",
        "pixels-out-of-gamut",
    }
    assert result.counts["pixels-not-finite"] == 1
    assert result.counts["pixels-out-of-gamut"] == 2  # below 0 and the colour
    found = read_channels(result.target, (*"RGB", *spectral.channels))
    assert np.isfinite(found).all()
    assert (found[0, [1, 4]] == 0).all()
    assert_allclose(found[0, 0, :3], 0.75)  # light without opacity
    assert_allclose(found[0, 3, :3], 0.375)
    assert_array_equal(channels(result.target)["A"], alpha)


def test_scenes_and_mitsuba_read_the_divided_colours(
    small_cube, multiplied, colours, alpha, sensor
):
    expected = np.where(alpha[..., None] > 0, colours, 0)
    found = np.concatenate(list(Images((multiplied,)).colours(multiplied, sensor)))
    assert_allclose(found.reshape(expected.shape), expected, rtol=0, atol=1e-6)
    texels = read_colours(multiplied, texture.prepare(small_cube).reader)[0]
    assert_allclose(texels, expected, rtol=0, atol=1e-6)


@pytest.mark.parametrize("band", [1 << 25, 1])
@pytest.mark.parametrize("max_side", [30, 11])
def test_pictures_are_means_weighted_by_alpha(
    max_side, band, multiplied, colours, alpha, sensor, monkeypatch
):
    monkeypatch.setattr("uplift.extras.images.image.MAX_BAND_BYTES", band)
    found = read_picture(multiplied, sensor, max_side=max_side)
    step = -(-30 // max_side)
    assert found.reduction == step
    for row in range(found.rgb.shape[0]):
        for column in range(found.rgb.shape[1]):
            top = step * row
            left = step * column
            block = np.s_[top : top + step, left : left + step]
            weights = alpha[block][..., None]
            total = (colours[block] * weights).sum(axis=(0, 1))
            mean = total / max(weights.sum(), 1e-9)
            assert_allclose(found.rgb[row, column], mean, rtol=0, atol=2e-6)
            assert_allclose(found.opacity[row, column], weights.mean(), rtol=1e-5)


def test_pictures_without_alpha(tmp_path, sensor):
    codes = np.array([[0, 255], [255, 0]], dtype=np.uint8)[..., None].repeat(3, axis=2)
    found = read_picture(
        write_image(tmp_path / "checks.png", codes), sensor, max_side=1
    )
    assert_allclose(found.rgb, 0.5)  # averaged as linear values
    path = write_exr(tmp_path / "fire.exr", planes(np.full((2, 2, 3), 2, np.float32)))
    found = read_picture(path, sensor, max_side=10)
    assert_array_equal(found.rgb, 1)
    assert [warning.code for warning in found.warnings] == ["pixels-out-of-gamut"]
    with raises(ColourError, "rgb-out-of-gamut"):
        read_picture(path, sensor, max_side=10, out_of_gamut="error")


@pytest.mark.parametrize(
    "encoding", [texture.Spectrum, texture.Moments, texture.Multipliers]
)
@pytest.mark.parametrize("method", ["clip", "desaturate", "error"])
def test_pixels_of_an_entry_outside_the_space_have_its_spectrum(
    cyan_cube, to_texture, tmp_path, encoding, method
):
    data = cyan_cube.data
    space = find_space("P3-D65")
    boxes = data.outside_boxes
    model = data.model
    pixels = np.stack([boxes.rgb[0], [0.2, 0.3, 0.4]])[None]
    if method != "error":  # halfway from the core of the box to its face, and outside
        shift = np.array([0, boxes.half_width[0], 0])
        pixels = np.concatenate(
            [pixels, [[boxes.rgb[0] + 0.55 * shift, boxes.rgb[0] + 2 * shift]]]
        )
    wide = (pixels @ np.linalg.inv(space.matrix_to(data.sensor)).T).astype(np.float32)
    uplifter = texture.prepare(
        cyan_cube, encoding(), depth="float", space="P3-D65", out_of_gamut=method
    )
    result = to_texture(planes(wide), uplifter)
    colours = rgb_of(result)
    numbers = read_channels(result.target, uplifter.channels).astype(float)
    if encoding is not texture.Spectrum:
        numbers = (
            model.from_storage(numbers) if encoding is texture.Moments else numbers
        )
        numbers = evaluate(
            model, numbers.reshape(-1, model.count), data.sensor.wavelengths
        )
        numbers = numbers.reshape(*pixels.shape[:2], -1)
    assert_allclose(colours[0], pixels[0], rtol=0, atol=1e-6)
    tolerance = 1e-3 if encoding is texture.Moments else 1e-4
    assert_allclose(data.sensor.rgb(numbers), colours, rtol=0, atol=tolerance)
    spectra = data.atlas.outside.spectra
    if encoding is not texture.Spectrum:
        spectra = EntrySpectra(model, data.atlas.outside.coefficients)
    stored = spectra.reflectance(np.array([0]), data.sensor.wavelengths)[0]
    assert_allclose(numbers[0, 0], stored, rtol=0, atol=1e-3)  # rounding of moments
    if method == "error":
        assert result.warnings == ()
        return
    assert [warning.code for warning in result.warnings] == ["pixels-out-of-gamut"]
    assert result.counts["pixels-out-of-gamut"] == 2
    mapped = map_to_gamut(pixels[1], data.sensor, method).rgb
    assert_allclose(
        colours[1], [(boxes.rgb[0] + mapped[0]) / 2, mapped[1]], rtol=0, atol=1e-5
    )


def test_pixels_near_an_entry_outside_the_space_are_refused_as_others(
    cyan_cube, to_texture, tmp_path
):
    boxes = cyan_cube.data.outside_boxes
    pixels = boxes.rgb[None] + boxes.half_width[0] / 2 * np.eye(3)[1]
    uplifter = texture.prepare(cyan_cube, out_of_gamut="error")
    with raises(ColourError, "rgb-out-of-gamut"):
        to_texture(planes(pixels.astype(np.float32)), uplifter)
