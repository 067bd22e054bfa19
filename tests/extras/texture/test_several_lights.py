"""Textures from photographs under several lights."""

from dataclasses import replace
from functools import partial
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


def converter(cube, further, path, kind=None, **options):
    kind = kind or texture.Spectrum()
    uplifter = texture.prepare(cube, kind, depth="float", threads=1)
    made = texture.prepare_several_lights(
        [uplifter], kind, further, threads=1, **options
    )
    return partial(texture.convert, made, also=(path,))


def under(light, **settings):
    return texture.FurtherPictures((texture.FurtherPicture(light),), **settings)


def spectra_of(path):
    return read_channels(path, spectral_channels("T", np.array(WAVELENGTHS)))


def test_a_relit_picture_gives_the_spectra_back(plain_cube, day, tmp_path):
    """Of the cube's own answers, under A, at another exposure that is not stated."""
    planes_of_day = channels(day)
    rgb = np.stack([planes_of_day[name] for name in "RGB"], axis=-1)
    lit = observer.sensor("sRGB", "A")
    relit = prepare_products(plain_cube.data, plain_cube.wavelengths, lit.matrix, 1)(
        rgb
    )
    write_exr(tmp_path / "a.exr", planes(relit.astype(np.float32)))
    made = converter(plain_cube, under("A"), tmp_path / "a.exr")
    conversion = made(day, tmp_path / "two.exr")
    assert "exposure × 1 " in conversion.facts[0]
    plain = texture.prepare(plain_cube, texture.Spectrum(), depth="float", threads=1)
    texture.convert(plain, day, tmp_path / "one.exr")
    assert_allclose(
        spectra_of(tmp_path / "two.exr"), spectra_of(tmp_path / "one.exr"), atol=2e-3
    )
    assert not channels(tmp_path / "two.exr")["contradiction"].any()


@pytest.mark.parametrize("noise", [0.0, 0.005])
def test_textures_come_nearer_to_the_materials(scene, plain_cube, day, tmp_path, noise):
    lit = observer.sensor("sRGB", "A")
    picture = photograph_of(scene, lit, exposure=1.3, noise=noise)
    write_exr(tmp_path / "a.exr", planes(picture))
    made = converter(plain_cube, under("A"), tmp_path / "a.exr")
    conversion = made(day, tmp_path / "two.exr")
    factor = float(conversion.facts[0].split()[3])
    assert factor == pytest.approx(1.3, rel=0.01)
    assert "shift 0.0" in conversion.facts[0]
    ratio = np.array(conversion.facts[1].split()[7:10], dtype=float)
    assert_allclose(ratio, 1, atol=0.05)
    rgb = scene @ plain_cube.data.sensor.matrix.T
    two = spectra_of(tmp_path / "two.exr")
    one = plain_cube.reflectance(np.clip(rgb, 0, 1))
    for name in ("A", "FL11", "HP1"):
        light = observer.light(name)
        errors = [
            uplift.colorimetry.delta_e_spectra(
                light, spectra.reshape(-1, 81), scene.reshape(-1, 81)
            ).mean()
            for spectra in (two, one)
        ]
        assert errors[0] < errors[1], name


def test_texture_and_python_agree(scene, plain_cube, day, tmp_path):
    lit = observer.sensor("sRGB", "A")
    picture = photograph_of(scene, lit)
    write_exr(tmp_path / "a.exr", planes(picture))
    further = texture.FurtherPictures(
        (texture.FurtherPicture("A", exposure=1.0),), noise=(0.002, 0.0002)
    )
    made = converter(plain_cube, further, tmp_path / "a.exr")
    made(day, tmp_path / "two.exr")
    prepared = prepare(
        plain_cube, [photograph(plain_cube.data.sensor, "A")], (0.002, 0.0002)
    )
    rgb = read_channels(day, "RGB")
    expected = prepared.reflectance(rgb, picture.astype(float))
    assert_allclose(spectra_of(tmp_path / "two.exr"), expected, atol=1e-4)


@pytest.mark.parametrize("kind", [texture.Moments(), texture.Multipliers()])
def test_coefficients_have_the_exact_colours(scene, plain_cube, day, tmp_path, kind):
    lit = observer.sensor("sRGB", "A")
    write_exr(tmp_path / "a.exr", planes(photograph_of(scene, lit)))
    made = converter(plain_cube, under("A"), tmp_path / "a.exr", kind)
    made(day, tmp_path / "two.exr")
    model = plain_cube.data.model
    names = [name for name in made.args[0].channels if name != "contradiction"]
    numbers = read_channels(tmp_path / "two.exr", names).reshape(-1, model.count)
    if isinstance(kind, texture.Moments):
        numbers = model.from_storage(numbers)
    spectra = uplift.models.evaluate(model, numbers, plain_cube.wavelengths)
    sensor = plain_cube.data.sensor
    rgb = read_channels(day, "RGB").reshape(-1, 3)
    assert_allclose(sensor.rgb(spectra), rgb, atol=2e-3)
    others = scene.reshape(-1, 81) @ lit.matrix.T
    off = np.abs(spectra @ lit.matrix.T - others).mean()
    plain = plain_cube.reflectance(rgb) @ lit.matrix.T
    assert off < np.abs(plain - others).mean()


def test_a_wrong_balance_is_doubted_by_greys(scene, plain_cube, day, tmp_path):
    lit = photograph(plain_cube.data.sensor, "A", balance="none").matrix
    write_exr(tmp_path / "a.exr", planes((scene @ lit.T).astype(np.float32)))
    for balance, is_doubted in (("light", True), ("none", False)):
        made = converter(plain_cube, under("A", balance=balance), tmp_path / "a.exr")
        facts = made(day, tmp_path / f"{balance}.exr").facts
        assert ("check the balance" in facts[1]) == is_doubted


def test_raw_values_of_a_camera_are_in_no_space(scene, plain_cube, day, tmp_path):
    """Of a camera under the light of the cube, in files that state spaces or none."""
    camera = "Nikon 5100 (NPL)"
    raw = photograph(plain_cube.data.sensor, "D65", camera).matrix
    values = (scene @ raw.T).astype(np.float32)
    wide = (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)
    write_exr(tmp_path / "plain.exr", planes(values))
    write_exr(tmp_path / "wide.exr", planes(values), chromaticities=wide)
    picture = texture.FurtherPicture("D65", camera=camera, exposure=1.0)
    further = texture.FurtherPictures((picture,), noise=(0.001, 0.0))
    answers = []
    for name in ("plain", "wide"):
        made = converter(plain_cube, further, tmp_path / f"{name}.exr")
        made(day, tmp_path / f"{name}-two.exr")
        answers.append(spectra_of(tmp_path / f"{name}-two.exr"))
    assert_array_equal(*answers)
    rgb = np.clip(scene @ plain_cube.data.sensor.matrix.T, 0, 1)
    plain = plain_cube.reflectance(rgb)
    light = observer.light("HP1")
    errors = [
        delta_e_spectra(light, spectra.reshape(-1, 81), scene.reshape(-1, 81)).mean()
        for spectra in (answers[0], plain)
    ]
    assert errors[0] < errors[1]


def test_masks_mix_cubes(scene, plain_cube, small_cube, day, tmp_path):
    lit = observer.sensor("sRGB", "A")
    write_exr(tmp_path / "a.exr", planes(photograph_of(scene, lit)))
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
    scene, plain_cube, tmp_path
):
    sensor = plain_cube.data.sensor
    codes = np.rint(255 * np.clip(scene @ sensor.matrix.T, 0, 1) ** (1 / 2.2))
    write_image(tmp_path / "day.png", codes.astype(np.uint8))
    lit = np.rint(255 * np.clip(scene @ observer.sensor("sRGB", "A").matrix.T, 0, 1))
    lit[:10] = 255
    lit[10:20] = 0
    write_image(tmp_path / "a.png", lit.astype(np.uint8))
    further = texture.FurtherPictures((texture.FurtherPicture("A", exposure=1.0),))
    made = converter(plain_cube, further, tmp_path / "a.png")
    made(tmp_path / "day.png", tmp_path / "two.exr")
    planes_of = channels(tmp_path / "two.exr")
    rgb = np.stack([planes_of[name] for name in "RGB"], axis=-1)[:20]
    expected = plain_cube.reflectance(rgb)
    assert_allclose(spectra_of(tmp_path / "two.exr")[:20], expected, atol=1e-3)
    assert not planes_of["contradiction"][:20].any()


def test_pictures_that_contradict_each_other_are_counted(plain_cube, tmp_path):
    grey = np.full((16, 16, 3), 0.2, np.float32)
    other = grey.copy()
    other[4:8, 4:8] = (0.9, 0.02, 0.02)
    write_exr(tmp_path / "day.exr", planes(grey))
    write_exr(tmp_path / "a.exr", planes(other))
    further = texture.FurtherPictures((texture.FurtherPicture("A", exposure=1.0),))
    made = converter(plain_cube, further, tmp_path / "a.exr")
    conversion = made(tmp_path / "day.exr", tmp_path / "two.exr")
    assert conversion.counts["photographs-contradict"] == 16
    assert "photographs-contradict" in [note.code for note in conversion.warnings]
    flags = channels(tmp_path / "two.exr")["contradiction"]
    assert flags.sum() == 16
    assert flags[4:8, 4:8].all()


def test_shifted_pictures_are_refused_with_the_shift(scene, plain_cube, day, tmp_path):
    picture = photograph_of(scene, observer.sensor("sRGB", "A"))
    write_exr(tmp_path / "a.exr", planes(np.roll(picture, (3, -2), axis=(0, 1))))
    made = converter(plain_cube, under("A"), tmp_path / "a.exr")
    with raises(TextureError, "photographs-not-aligned") as caught:
        made(day, tmp_path / "two.exr")
    assert "-2.0" in caught.value.problem
    assert "+3.0" in caught.value.problem
    assert not Path(tmp_path / "two.exr").exists()


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
    scene, plain_cube, day, tmp_path, repository
):
    lit = observer.sensor("sRGB", "A")
    picture = write_exr(tmp_path / "a.exr", planes(photograph_of(scene, lit)))
    settings = TextureSettings(
        cubes=(str(repository / "cubes" / "moments-8.uplift"),),
        also=under("A"),
        threads=1,
    )
    job = Job(settings, day, tmp_path / "two.exr", also=(picture,))
    assert run(job).facts
    assert is_complete(replace(job, resume=True))
    write_exr(picture, planes(photograph_of(scene, lit, exposure=0.9)))
    assert not is_complete(replace(job, resume=True, force=True))


def test_bad_input(plain_cube, day, tmp_path):
    small = write_exr(
        tmp_path / "small.exr", planes(np.full((8, 8, 3), 0.5, np.float32))
    )
    with raises(TextureError, "photographs-of-different-sizes"):
        converter(plain_cube, under("A"), small)(day, tmp_path / "two.exr")
    with raises(TextureError):
        made = converter(plain_cube, under("A"), tmp_path / "none.exr")
        made(day, tmp_path / "two.exr")
    with raises(OptionError):
        converter(plain_cube, under("D65"), small)
    with raises(OptionError):
        converter(plain_cube, texture.FurtherPictures(()), small)
    with raises(OptionError):
        two = texture.FurtherPictures((texture.FurtherPicture("A"),) * 2)
        converter(plain_cube, two, small)


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


def test_a_chart_states_exposure_balance_and_noise(plain_cube, tmp_path):
    scene = chart_scene(plain_cube)
    sensor = plain_cube.data.sensor
    lit = observer.sensor("sRGB", "A")
    first = np.clip(photograph_of(scene, sensor, exposure=0.8, noise=0.01), 0, 1)
    second = photograph_of(scene, lit, noise=0.01) * np.float32([1.3, 1.2, 1.0])
    day = write_exr(tmp_path / "day.exr", planes(first))
    write_exr(tmp_path / "a.exr", planes(second.astype(np.float32)))
    further = under("A", chart=texture.ChartInPicture(CORNERS))
    made = converter(plain_cube, further, tmp_path / "a.exr")
    facts = made(day, tmp_path / "two.exr").facts
    assert float(facts[0].split()[5]) == pytest.approx(0.8, rel=0.02)
    gains = np.array(facts[1].split()[5:8], dtype=float)
    assert_allclose(gains, np.array([1.3, 1.2, 1.0]) / 0.8, rtol=0.02)
    assert float(facts[2].split()[1].rstrip("%")) == pytest.approx(1, abs=0.3)
    mean = float(facts[3].split("A ")[1].split(",")[0])
    assert mean < 0.5
    assert facts[4].startswith("  dark skin: A ")
    assert len(facts) == 4 + 24


@pytest.mark.parametrize("order", ["1230", "2301", "3012", "0321", "1032", "0132"])
def test_corners_that_are_turned_or_mirrored_are_refused(plain_cube, tmp_path, order):
    scene = chart_scene(plain_cube)
    lights = {"day": "D65", "a": "A"}
    for name, light in lights.items():
        rgb = photograph_of(scene, observer.sensor("sRGB", light), noise=0.02)
        write_exr(tmp_path / f"{name}.exr", planes(rgb.astype(np.float32)))
    corners = np.reshape(CORNERS, (4, 2))[list(map(int, order))]
    chart = texture.ChartInPicture(tuple(corners.ravel()))
    made = converter(plain_cube, under("A", chart=chart), tmp_path / "a.exr")
    with raises(OptionError) as caught:
        made(tmp_path / "day.exr", tmp_path / "two.exr")
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
def test_charts_that_cannot_be_used_are_refused(plain_cube, day, tmp_path, chart):
    picture = Path(tmp_path / "a.exr")
    rgb = read_channels(day, "RGB") * np.float32([1.1, 1.0, 0.9])
    write_exr(picture, planes(rgb))
    made = converter(plain_cube, under("A", chart=chart), picture)
    with raises(OptionError):
        made(day, tmp_path / "two.exr")
