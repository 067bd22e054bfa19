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
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError, TextureError
from uplift.extras import texture
from uplift.extras.photographs.answers import prepare
from uplift.extras.photographs.chart import homography
from uplift.extras.photographs.fit import estimate_noise, shift
from uplift.extras.photographs.photograph import Noise, photograph
from uplift.extras.texture.encodings import spectral_channels
from uplift.extras.texture.sequence import Job, TextureSettings, is_complete, run
from uplift.lookup.node_table import prepare_products

from .conftest import channels, planes, read_channels, write_exr, write_image

SIZE = 96
PATCH = 8
RANDOM = np.random.default_rng(11)
WAVELENGTHS = tuple(observer.grid().tolist())


@pytest.fixture(scope="module")
def scene(plain_cube):
    """Reflectances (SIZE, SIZE, 81) of patches of measured materials, shaded."""
    sensor = plain_cube.data.sensor
    atlas = uplift.read_atlas(ATLASES / "pmc.txt")
    spectra = resample(atlas, sensor.wavelengths).values
    spectra = spectra[in_unit_cube(sensor.rgb(spectra))]
    count = SIZE // PATCH
    patches = spectra[RANDOM.integers(len(spectra), size=(count, count))]
    shade = 0.6 + 0.4 * RANDOM.random((count * 2, count * 2, 1))
    large = np.kron(patches, np.ones((PATCH, PATCH, 1)))
    return large * np.kron(shade, np.ones((PATCH // 2, PATCH // 2, 1)))


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

    def convert(other, further=None, kind=None, first=day):
        if not isinstance(other, Path):
            other = write_exr(tmp_path / "a.exr", planes(other.astype(np.float32)))
        kind = kind or texture.Spectrum()
        uplifter = texture.prepare(plain_cube, kind, depth="float", threads=1)
        made = texture.prepare_several_lights(
            [uplifter], kind, further or under("A"), threads=1
        )
        target = tmp_path / "two.exr"
        return texture.convert(made, first, target, also=[other], force=True)

    return convert


@pytest.fixture
def tungsten(scene):
    """Linear RGB of the scene under A."""
    return photograph_of(scene, observer.sensor("sRGB", "A"))


def mean_error(name, spectra, scene):
    """Mean ΔE00 under a light."""
    pair = (spectra.reshape(-1, 81), scene.reshape(-1, 81))
    return delta_e_spectra(observer.light(name), *pair).mean()


def under(light, **settings):
    return texture.FurtherPictures((texture.FurtherPicture(light),), **settings)


def spectra_of(path):
    return read_channels(path, spectral_channels("T", np.array(WAVELENGTHS)))


def test_a_relit_picture_gives_the_spectra_back(plain_cube, day, convert, tmp_path):
    """Of the cube's own answers, under A, at another exposure that is not stated."""
    lit = observer.sensor("sRGB", "A")
    relit = prepare_products(plain_cube.data, plain_cube.wavelengths, lit.matrix, 1)
    conversion = convert(relit(read_channels(day, "RGB")))
    assert "exposure × 1 " in conversion.facts[0]
    plain = texture.prepare(plain_cube, texture.Spectrum(), depth="float", threads=1)
    one = texture.convert(plain, day, tmp_path / "one.exr").target
    assert_allclose(spectra_of(conversion.target), spectra_of(one), atol=2e-3)
    assert not channels(conversion.target)["contradiction"].any()


@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_textures_come_nearer_to_the_materials(scene, plain_cube, convert, noise):
    lit = observer.sensor("sRGB", "A")
    conversion = convert(photograph_of(scene, lit, exposure=1.3, noise=noise))
    factor = float(conversion.facts[0].split()[3])
    assert factor == pytest.approx(1.3, rel=0.01)
    assert "shift 0.0" in conversion.facts[0]
    ratio = np.array(conversion.facts[1].split()[7:10], dtype=float)
    assert_allclose(ratio, 1, atol=0.05)
    two = spectra_of(conversion.target)
    one = plain_cube.reflectance(np.clip(scene @ plain_cube.data.sensor.matrix.T, 0, 1))
    for name in ("A", "FL11", "HP1"):
        assert mean_error(name, two, scene) < mean_error(name, one, scene), name


def test_texture_and_python_agree(plain_cube, day, convert, tungsten):
    noise = (0.002, 0.0002)
    further = texture.FurtherPictures(
        (texture.FurtherPicture("A", exposure=1.0),), noise=noise
    )
    conversion = convert(tungsten, further)
    prepared = prepare(plain_cube, [photograph(plain_cube.data.sensor, "A")], noise)
    expected = prepared.reflectance(read_channels(day, "RGB"), tungsten.astype(float))
    assert_allclose(spectra_of(conversion.target), expected, atol=1e-4)


@pytest.mark.parametrize("kind", [texture.Moments(), texture.Multipliers()])
def test_coefficients_have_the_exact_colours(
    scene, plain_cube, day, convert, tungsten, kind
):
    target = convert(tungsten, kind=kind).target
    model = plain_cube.data.model
    names = texture.prepare(plain_cube, kind).channels
    numbers = read_channels(target, names).reshape(-1, model.count)
    if isinstance(kind, texture.Moments):
        numbers = model.from_storage(numbers)
    spectra = uplift.models.evaluate(model, numbers, plain_cube.wavelengths)
    sensor = plain_cube.data.sensor
    rgb = read_channels(day, "RGB").reshape(-1, 3)
    assert_allclose(sensor.rgb(spectra), rgb, atol=2e-3)
    lit = observer.sensor("sRGB", "A")
    others = scene.reshape(-1, 81) @ lit.matrix.T
    off = np.abs(spectra @ lit.matrix.T - others).mean()
    plain = plain_cube.reflectance(rgb) @ lit.matrix.T
    assert off < np.abs(plain - others).mean()


def test_a_wrong_balance_is_doubted_by_greys(scene, plain_cube, convert):
    lit = photograph(plain_cube.data.sensor, "A", balance="none").matrix
    for balance, is_doubted in (("light", True), ("none", False)):
        facts = convert(scene @ lit.T, under("A", balance=balance)).facts
        assert ("check the balance" in facts[1]) == is_doubted


def test_raw_values_of_a_camera_are_in_no_space(scene, plain_cube, convert, tmp_path):
    """Of a camera under the light of the cube, in files that state spaces or none."""
    camera = "Nikon 5100 (NPL)"
    raw = photograph(plain_cube.data.sensor, "D65", camera).matrix
    values = planes((scene @ raw.T).astype(np.float32))
    wide = (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)
    picture = texture.FurtherPicture("D65", camera=camera, exposure=1.0)
    further = texture.FurtherPictures((picture,), noise=(0.001, 0.0))
    answers = []
    for header in ({}, {"chromaticities": wide}):
        path = write_exr(tmp_path / "a.exr", values, **header)
        answers.append(spectra_of(convert(path, further).target))
    assert_array_equal(*answers)
    plain = plain_cube.reflectance(
        np.clip(scene @ plain_cube.data.sensor.matrix.T, 0, 1)
    )
    assert mean_error("HP1", answers[0], scene) < mean_error("HP1", plain, scene)


def test_masks_mix_cubes(tungsten, plain_cube, small_cube, day, tmp_path):
    write_exr(tmp_path / "a.exr", planes(tungsten))
    mask = np.zeros((SIZE, SIZE, 1), dtype=np.uint8)
    mask[:, SIZE // 2 :] = 1
    write_image(tmp_path / "mask.png", mask)
    kind = texture.Spectrum()
    parts = {}
    for name, cubes, options in (
        ("mixed", [plain_cube, small_cube], {"mask": tmp_path / "mask.png"}),
        ("plain", [plain_cube], {}),
        ("small", [small_cube], {}),
    ):
        uplifters = [
            texture.prepare(cube, kind, depth="float", threads=1) for cube in cubes
        ]
        further = under("A", noise=(0.001, 0.0))
        made = texture.prepare_several_lights(
            uplifters, kind, further, threads=1, **options
        )
        target = tmp_path / f"{name}.exr"
        texture.convert(made, day, target, also=[tmp_path / "a.exr"])
        parts[name] = spectra_of(tmp_path / f"{name}.exr")
    half = SIZE // 2
    assert_allclose(parts["mixed"][:, :half], parts["plain"][:, :half], atol=1e-6)
    assert_allclose(parts["mixed"][:, half:], parts["small"][:, half:], atol=2e-3)


def test_clipped_and_black_pixels_are_answered_by_the_first(
    scene, plain_cube, tungsten, convert, tmp_path
):
    sensor = plain_cube.data.sensor
    codes = np.rint(255 * np.clip(scene @ sensor.matrix.T, 0, 1) ** (1 / 2.2))
    first = write_image(tmp_path / "day.png", codes.astype(np.uint8))
    lit = np.rint(255 * np.clip(tungsten, 0, 1))
    lit[:10] = 255
    lit[10:20] = 0
    other = write_image(tmp_path / "a.png", lit.astype(np.uint8))
    further = texture.FurtherPictures((texture.FurtherPicture("A", exposure=1.0),))
    target = convert(other, further, first=first).target
    expected = plain_cube.reflectance(read_channels(target, "RGB")[:20])
    assert_allclose(spectra_of(target)[:20], expected, atol=1e-3)
    assert not channels(target)["contradiction"][:20].any()


def test_pictures_that_contradict_each_other_are_counted(convert, tmp_path):
    grey = np.full((16, 16, 3), 0.2, np.float32)
    other = grey.copy()
    other[4:8, 4:8] = (0.9, 0.02, 0.02)
    first = write_exr(tmp_path / "grey.exr", planes(grey))
    further = texture.FurtherPictures((texture.FurtherPicture("A", exposure=1.0),))
    conversion = convert(other, further, first=first)
    assert conversion.counts["photographs-contradict"] == 16
    assert "photographs-contradict" in [note.code for note in conversion.warnings]
    flags = channels(conversion.target)["contradiction"]
    assert flags.sum() == 16
    assert flags[4:8, 4:8].all()


def test_shifted_pictures_are_refused_with_the_shift(convert, tungsten, tmp_path):
    with raises(TextureError, "photographs-not-aligned") as caught:
        convert(np.roll(tungsten, (3, -2), axis=(0, 1)))
    assert "-2.0" in caught.value.problem
    assert "+3.0" in caught.value.problem
    assert not (tmp_path / "two.exr").exists()


@pytest.mark.parametrize("place", [(0.0, 0.0), (2.0, -3.0), (0.5, 0.25)])
def test_shifts_are_measured_below_a_pixel(place):
    detail = RANDOM.standard_normal((64, 64))
    spectrum = np.fft.fft2(detail) * np.exp(-8 * _frequencies(64, 64))
    down, right = place
    y, x = np.fft.fftfreq(64)[:, None], np.fft.fftfreq(64)
    moved = np.fft.ifft2(spectrum * np.exp(-2j * np.pi * (y * down + x * right))).real
    first = np.fft.ifft2(spectrum).real
    assert_allclose(shift(first + 10, moved + 10), place, atol=0.3)
    assert shift(np.ones((64, 64)), moved) is None


def _frequencies(height, width):
    return np.hypot(np.fft.fftfreq(height)[:, None], np.fft.fftfreq(width))


@pytest.mark.parametrize(("share", "floor"), [(0.01, 0.0), (0.0, 0.003), (0.01, 0.002)])
def test_noise_is_estimated_from_flat_areas(share, floor):
    levels = np.repeat(np.linspace(0.02, 0.8, 24), 16)
    band = np.tile(levels[:, None], (24, 1, 3))
    band = band + RANDOM.standard_normal(band.shape) * np.sqrt(
        (share * band) ** 2 + floor**2
    )
    noise = estimate_noise([band] * 4, 0)
    for level in (0.05, 0.7):
        expected = np.hypot(share * level, floor)
        assert np.sqrt(noise.variance(np.array(level))) == pytest.approx(
            expected, rel=0.35
        )
    assert estimate_noise([np.full((16, 16, 3), 0.5)], 255).share == 1 / 255
    assert estimate_noise([], 0) == Noise()
    assert estimate_noise([band[:8, :8]], 0).variance(np.array(0.5)) >= 0


def test_sequences_resume_and_differ_by_their_photographs(
    tungsten, day, tmp_path, repository
):
    picture = write_exr(tmp_path / "a.exr", planes(tungsten))
    settings = TextureSettings(
        cubes=(str(repository / "cubes" / "moments-8.uplift"),),
        also=under("A"),
        threads=1,
    )
    job = Job(settings, day, tmp_path / "two.exr", also=(picture,))
    assert run(job).facts
    assert is_complete(replace(job, resume=True))
    write_exr(picture, planes(tungsten * np.float32(0.9)))
    assert not is_complete(replace(job, resume=True, force=True))


def test_bad_input(convert, tungsten, tmp_path):
    with raises(TextureError, "photographs-of-different-sizes"):
        convert(np.full((8, 8, 3), 0.5))
    with raises(TextureError):
        convert(tmp_path / "none.exr")
    two = texture.FurtherPictures((texture.FurtherPicture("A"),) * 2)
    for further in (under("D65"), texture.FurtherPictures(()), two):
        with raises(OptionError):
            convert(tungsten, further)


CORNERS = (8.0, 8.0, 90.0, 12.0, 86.0, 70.0, 5.0, 66.0)


def chart_scene(plain_cube):
    """A ColorChecker in perspective on grey, (SIZE, SIZE, 81)."""
    atlas = uplift.read_atlas(ATLASES / "macbeth.txt")
    measured = resample(atlas, plain_cube.wavelengths).values
    inverse = np.linalg.inv(homography(np.reshape(CORNERS, (4, 2))))
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    places = np.stack([x, y, np.ones_like(x)], axis=-1) @ inverse.T
    u, v = places[..., 0] / places[..., 2], places[..., 1] / places[..., 2]
    inside = (u >= 0) & (u < 1) & (v >= 0) & (v < 1)
    column = np.clip((6 * u).astype(int), 0, 5)
    row = np.clip((4 * v).astype(int), 0, 3)
    scene = np.full((SIZE, SIZE, 81), 0.3)
    scene[inside] = measured[(6 * row + column)[inside]]
    return scene


def test_a_chart_states_exposure_balance_and_noise(plain_cube, convert, tmp_path):
    scene = chart_scene(plain_cube)
    sensor = plain_cube.data.sensor
    lit = observer.sensor("sRGB", "A")
    first = np.clip(photograph_of(scene, sensor, exposure=0.8, noise=0.01), 0, 1)
    second = photograph_of(scene, lit, noise=0.01) * np.float32([1.3, 1.2, 1.0])
    path = write_exr(tmp_path / "chart.exr", planes(first))
    further = under("A", chart=texture.ChartInPicture(CORNERS))
    facts = convert(second, further, first=path).facts
    assert float(facts[0].split()[5]) == pytest.approx(0.8, rel=0.02)
    gains = np.array(facts[1].split()[5:8], dtype=float)
    assert_allclose(gains, np.array([1.3, 1.2, 1.0]) / 0.8, rtol=0.02)
    assert float(facts[2].split()[1].rstrip("%")) == pytest.approx(1, abs=0.3)
    mean = float(facts[3].split("A ")[1].split(",")[0])
    assert mean < 0.5
    assert facts[4].startswith("  dark skin: A ")
    assert len(facts) == 4 + 24


@pytest.mark.parametrize("order", ["1230", "2301", "3012", "0321", "1032", "0132"])
def test_corners_that_are_turned_or_mirrored_are_refused(
    plain_cube, convert, tmp_path, order
):
    scene = chart_scene(plain_cube)
    first, second = (
        photograph_of(scene, observer.sensor("sRGB", light), noise=0.02)
        for light in ("D65", "A")
    )
    path = write_exr(tmp_path / "chart.exr", planes(first))
    corners = np.reshape(CORNERS, (4, 2))[list(map(int, order))]
    chart = texture.ChartInPicture(tuple(corners.ravel()))
    with raises(OptionError) as caught:
        convert(second, under("A", chart=chart), first=path)
    if order != "0132":  # its sides cross
        assert caught.value.code == "chart-differs"
        assert ",".join(f"{number:g}" for number in CORNERS) in caught.value.hint


@pytest.mark.parametrize(
    "chart",
    [
        texture.ChartInPicture((0.0, 0.0, 900.0, 0.0, 900.0, 900.0, 0.0, 900.0)),
        texture.ChartInPicture((0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0)),
        texture.ChartInPicture(CORNERS, str(ATLASES / "pmc.txt")),
    ],
    ids=["outside", "on a line", "30 entries"],
)
def test_charts_that_cannot_be_used_are_refused(convert, day, chart):
    with raises(OptionError):
        convert(read_channels(day, "RGB") * [1.1, 1.0, 0.9], under("A", chart=chart))
