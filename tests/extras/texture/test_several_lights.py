"""Textures from photographs under several lights."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ATLASES
from tests.helpers import raises
from uplift.atlas.resampling import resample
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError, TextureError
from uplift.extras import texture
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.chart import homography
from uplift.extras.photographs.fit import estimate_noise, shift
from uplift.extras.photographs.photograph import Noise, photograph
from uplift.extras.texture.encodings import spectral_channels
from uplift.extras.texture.sequence import Job, TextureSettings, is_complete, run

from .conftest import (
    channels,
    planes,
    read_channels,
    spectra_by,
    write_exr,
    write_image,
)
from .image_bytes import BT2020

SIZE = 64
PATCH = 8
RANDOM = np.random.default_rng(11)
SPECTRUM = texture.Spectrum()


@pytest.fixture(scope="module")
def scene(plain_cube):
    """Reflectances (SIZE, SIZE, 81) of patches of measured materials."""
    sensor = plain_cube.data.sensor
    atlas = uplift.read_atlas(ATLASES / "pmc.txt")
    spectra = resample(atlas, sensor.wavelengths).values
    spectra = spectra[in_unit_cube(sensor.rgb(spectra))]
    rows = RANDOM.integers(len(spectra), size=(SIZE // PATCH, SIZE // PATCH))
    return np.kron(spectra[rows], np.ones((PATCH, PATCH, 1)))


def photograph_of(scene, sensor, *, exposure=1.0, noise=0.0):
    rgb = scene @ sensor.matrix.T * exposure
    return (rgb * (1 + noise * RANDOM.standard_normal(rgb.shape))).astype(np.float32)


@pytest.fixture
def day(scene, plain_cube, tmp_path):
    rgb = np.clip(photograph_of(scene, plain_cube.data.sensor), 0, 1)
    return write_exr(tmp_path / "day.exr", planes(rgb))


@pytest.fixture
def convert(plain_cube, day, tmp_path):
    """Function that converts the first picture with another one, which is a file or
    linear RGB.
    """

    def convert(
        other, further=None, kind=SPECTRUM, first=day, cubes=(plain_cube,), **options
    ):
        if not isinstance(other, Path):
            other = write_exr(tmp_path / "a.exr", planes(other.astype(np.float32)))
        uplifters = [
            texture.prepare(cube, kind, depth="float", threads=1) for cube in cubes
        ]
        made = texture.prepare_several_lights(
            uplifters, kind, further or under("A"), threads=1, **options
        )
        target = tmp_path / "two.exr"
        return texture.convert(made, first, target, also=[other], force=True)

    return convert


@pytest.fixture
def tungsten(scene):
    """Linear RGB of the scene under A."""
    return photograph_of(scene, observer.sensor("sRGB", "A"))


def under(light, **settings):
    picture = {
        name: settings.pop(name) for name in ("camera", "exposure") & settings.keys()
    }
    pictures = (texture.FurtherPicture(light, **picture),)
    return texture.FurtherPictures(pictures, **settings)


def spectra_of(conversion):
    names = spectral_channels("T", observer.grid())
    return read_channels(conversion.target, names)


def test_exposure_balance_and_shift_are_estimated(scene, convert):
    lit = observer.sensor("sRGB", "A")
    facts = convert(photograph_of(scene, lit, exposure=1.3, noise=0.005)).facts
    assert float(facts[0].split()[3]) == pytest.approx(1.3, rel=0.01)
    assert "shift 0.0" in facts[0]
    assert_allclose(np.array(facts[1].split()[7:10], dtype=float), 1, atol=0.05)


@pytest.mark.parametrize(
    ("light", "camera", "header"),
    [
        ("A", None, {}),
        ("D65", "Nikon 5100 (NPL)", {}),
        ("D65", "Nikon 5100 (NPL)", {"chromaticities": BT2020}),  # they have none
    ],
)
def test_texture_and_python_agree(
    light, camera, header, scene, plain_cube, day, convert, tmp_path
):
    noise = (0.002, 0.0002)
    lit = photograph(plain_cube.data.sensor, light, camera)
    rgb = (scene @ lit.matrix.T).astype(np.float32)
    other = write_exr(tmp_path / "other.exr", planes(rgb), **header)
    further = under(light, camera=camera, exposure=1.0, noise=noise)
    found = spectra_of(convert(other, further))
    prepared = prepare(plain_cube, [lit], noise)
    expected = prepared.reflectance(read_channels(day, "RGB"), rgb.astype(float))
    assert_allclose(found, expected, atol=1e-4)


@pytest.mark.parametrize("kind", [texture.Moments(), texture.Multipliers()])
def test_coefficients_have_the_exact_colours(plain_cube, day, convert, tungsten, kind):
    names = texture.prepare(plain_cube, kind).channels
    numbers = read_channels(convert(tungsten, kind=kind).target, names)
    spectra = spectra_by(numbers, kind, plain_cube)
    rgb = read_channels(day, "RGB")
    assert_allclose(plain_cube.data.sensor.rgb(spectra), rgb, atol=2e-3)
    lit = observer.sensor("sRGB", "A").matrix.T
    plain = plain_cube.reflectance(rgb) @ lit
    assert np.abs(spectra @ lit - tungsten).mean() < np.abs(plain - tungsten).mean()


def test_a_wrong_balance_is_doubted_by_greys(scene, plain_cube, convert):
    lit = photograph(plain_cube.data.sensor, "A", balance="none").matrix
    for balance, is_doubted in (("light", True), ("none", False)):
        facts = convert(scene @ lit.T, under("A", balance=balance)).facts
        assert ("check the balance" in facts[1]) == is_doubted


def test_masks_mix_cubes(tungsten, plain_cube, small_cube, convert, tmp_path):
    half = SIZE // 2
    mask = np.zeros((SIZE, SIZE, 1), dtype=np.uint8)
    mask[:, half:] = 1
    path = write_image(tmp_path / "mask.png", mask)
    further = under("A", noise=(0.001, 0.0))
    both = (plain_cube, small_cube)
    mixed = spectra_of(convert(tungsten, further, cubes=both, mask=path))
    for cube, part in zip(both, (np.s_[:, :half], np.s_[:, half:]), strict=True):
        alone = spectra_of(convert(tungsten, further, cubes=(cube,)))
        assert_allclose(mixed[part], alone[part], atol=2e-3)


def test_clipped_and_black_pixels_are_answered_by_the_first(
    scene, plain_cube, tungsten, convert, tmp_path
):
    rgb = np.clip(scene @ plain_cube.data.sensor.matrix.T, 0, 1)
    codes = np.rint(255 * rgb ** (1 / 2.2)).astype(np.uint8)
    first = write_image(tmp_path / "day.png", codes)
    lit = np.rint(255 * np.clip(tungsten, 0, 1))
    lit[:10] = 255
    lit[10:20] = 0
    other = write_image(tmp_path / "a.png", lit.astype(np.uint8))
    conversion = convert(other, under("A", exposure=1.0), first=first)
    expected = plain_cube.reflectance(read_channels(conversion.target, "RGB")[:20])
    assert_allclose(spectra_of(conversion)[:20], expected, atol=1e-3)
    assert not channels(conversion.target)["contradiction"][:20].any()


def test_pictures_that_contradict_each_other_are_counted(convert, tmp_path):
    grey = np.full((16, 16, 3), 0.2, np.float32)
    other = grey.copy()
    other[4:8, 4:8] = (0.9, 0.02, 0.02)
    first = write_exr(tmp_path / "grey.exr", planes(grey))
    conversion = convert(other, under("A", exposure=1.0), first=first)
    assert conversion.counts["photographs-contradict"] == 16
    assert "photographs-contradict" in [note.code for note in conversion.warnings]
    flags = channels(conversion.target)["contradiction"]
    assert_array_equal(flags, other[..., 0] == np.float32(0.9))


def test_shifted_pictures_are_refused_with_the_shift(convert, tungsten, tmp_path):
    with raises(TextureError, "photographs-not-aligned") as caught:
        convert(np.roll(tungsten, (3, -2), axis=(0, 1)))
    assert "-2.0" in caught.value.problem
    assert "+3.0" in caught.value.problem
    assert not (tmp_path / "two.exr").exists()


def test_shifts_are_measured_below_a_pixel():
    y, x = np.fft.fftfreq(64)[:, None], np.fft.fftfreq(64)
    detail = np.fft.fft2(RANDOM.standard_normal((64, 64))) * np.exp(-8 * np.hypot(y, x))
    waves = np.exp(-2j * np.pi * (0.5 * y + 0.25 * x))
    first, moved = np.fft.ifft2([detail, detail * waves]).real
    assert_allclose(shift(first + 10, moved + 10), (0.5, 0.25), atol=0.3)
    assert shift(np.ones((64, 64)), moved) is None


def test_noise_is_estimated_from_flat_areas():
    levels = np.repeat(np.linspace(0.02, 0.8, 24), 16)
    band = np.tile(levels[:, None], (24, 1, 3))
    deviation = np.hypot(0.01 * band, 0.002)
    band = band + RANDOM.standard_normal(band.shape) * deviation
    noise = estimate_noise([band] * 4, 0)
    for level in (0.05, 0.7):
        expected = np.hypot(0.01 * level, 0.002)
        assert np.sqrt(noise.variance(level)) == pytest.approx(expected, rel=0.35)
    assert estimate_noise([np.full((16, 16, 3), 0.5)], 255).share == 1 / 255
    assert estimate_noise([], 0) == Noise()
    assert estimate_noise([band[:8, :8]], 0).variance(0.5) >= 0  # a block, many levels


def test_sequences_resume_and_differ_by_their_photographs(
    tungsten, day, tmp_path, repository
):
    picture = write_exr(tmp_path / "a.exr", planes(tungsten))
    cube = str(repository / "cubes" / "moments-8.uplift")
    settings = TextureSettings(cubes=(cube,), also=under("A"), threads=1)
    job = Job(settings, day, tmp_path / "two.exr", also=(picture,))
    assert run(job).facts
    assert is_complete(replace(job, resume=True))
    write_exr(picture, planes(tungsten * np.float32(0.9)))
    assert not is_complete(replace(job, resume=True, force=True))


CORNERS = (6.0, 5.0, 60.0, 8.0, 57.0, 47.0, 4.0, 44.0)
TWICE = texture.FurtherPictures((texture.FurtherPicture("A"),) * 2)
FAR = (0.0, 0.0, 900.0, 0.0, 900.0, 900.0, 0.0, 900.0)
ON_A_LINE = (0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0)
CROSSED = (*CORNERS[2:4], *CORNERS[:2], *CORNERS[4:])


def by_chart(corners, *atlas):
    """Settings of a picture under A that is calibrated by a chart."""
    return under("A", chart=texture.ChartInPicture(tuple(corners), *atlas))


@pytest.mark.parametrize(
    "further",
    [
        under("D65"),
        texture.FurtherPictures(()),
        TWICE,
        by_chart(FAR),
        by_chart(ON_A_LINE),
        by_chart(CROSSED),
        by_chart(CORNERS, str(ATLASES / "pmc.txt")),  # of 30 entries
    ],
)
def test_settings_that_cannot_be_used_are_refused(further, convert, tungsten):
    with raises(OptionError):
        convert(tungsten, further)


def test_pictures_that_cannot_be_used_are_refused(convert, tmp_path):
    with raises(TextureError, "photographs-of-different-sizes"):
        convert(np.full((8, 8, 3), 0.5))
    with raises(TextureError, "file-not-found"):
        convert(tmp_path / "none.exr")


@pytest.fixture
def chart_scene(plain_cube):
    """A ColorChecker in perspective on grey, (SIZE, SIZE, 81)."""
    atlas = uplift.read_atlas(ATLASES / "macbeth.txt")
    measured = resample(atlas, plain_cube.wavelengths).values
    inverse = np.linalg.inv(homography(np.reshape(CORNERS, (4, 2))))
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    places = np.stack([x, y, np.ones_like(x)], axis=-1) @ inverse.T
    u, v = np.moveaxis(places[..., :2] / places[..., 2:], -1, 0)
    inside = (u >= 0) & (u < 1) & (v >= 0) & (v < 1)
    patch = 6 * np.floor(4 * v) + np.floor(6 * u)
    scene = np.full((SIZE, SIZE, 81), 0.3)
    scene[inside] = measured[patch[inside].astype(int)]
    return scene


def test_a_chart_states_exposure_balance_and_noise(
    plain_cube, chart_scene, convert, tmp_path
):
    sensor = plain_cube.data.sensor
    lit = observer.sensor("sRGB", "A")
    first = np.clip(photograph_of(chart_scene, sensor, exposure=0.8, noise=0.01), 0, 1)
    second = photograph_of(chart_scene, lit, noise=0.01) * np.float32([1.3, 1.2, 1.0])
    path = write_exr(tmp_path / "chart.exr", planes(first))
    facts = convert(second, by_chart(CORNERS), first=path).facts
    assert float(facts[0].split()[5]) == pytest.approx(0.8, rel=0.02)
    gains = np.array(facts[1].split()[5:8], dtype=float)
    assert_allclose(gains, np.array([1.3, 1.2, 1.0]) / 0.8, rtol=0.02)
    assert float(facts[2].split()[1].rstrip("%")) == pytest.approx(1, abs=0.3)
    mean = float(facts[3].split("A ")[1].split(",")[0])
    assert mean < 0.5
    assert facts[4].startswith("  dark skin: A ")
    assert len(facts) == 4 + 24


@pytest.mark.parametrize("order", [[1, 2, 3, 0], [2, 3, 0, 1], [0, 3, 2, 1]])
def test_corners_that_are_turned_or_mirrored_are_refused(
    chart_scene, convert, tmp_path, order
):
    first, second = (
        photograph_of(chart_scene, observer.sensor("sRGB", light), noise=0.02)
        for light in ("D65", "A")
    )
    path = write_exr(tmp_path / "chart.exr", planes(first))
    corners = np.reshape(CORNERS, (4, 2))[order]
    with raises(OptionError, "chart-differs") as caught:
        convert(second, by_chart(corners.ravel()), first=path)
    assert ",".join(f"{number:g}" for number in CORNERS) in caught.value.hint
