"""Images and spectral textures in Mitsuba: texels in scalar and JIT variants, and the
spectra of models.
"""

import itertools
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises, run_python, warns
from tests.parts import LLVM, need
from uplift.colorimetry.gamut import map_to_gamut
from uplift.common.errors import TextureError
from uplift.extras import texture as textures
from uplift.extras.mitsuba.texels import read_texels
from uplift.extras.mitsuba.texture import blend
from uplift.models.model import evaluate
from uplift.models.moments import Moments
from uplift.models.sigmoid import Sigmoid

pytestmark = pytest.mark.filterwarnings(
    "ignore:the texture calls Python:uplift.UpliftWarning"
)

IMAGE = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
POSITIONS = [
    (0.1, 0.2),
    (0.83, 0.4),
    (0.999, 0.001),
    (0.5, 0.5),
    (1.3, -0.7),
    (-0.2, 1.9),
]
AT = np.array([450.0, 650.0])


@pytest.fixture
def texture(mi, cube_path):
    """Function that makes a texture, by default of `IMAGE`."""

    def texture(image=IMAGE, **options):
        source = {} if image is None else {"bitmap": mi.Bitmap(image)}
        return mi.load_dict({"type": "uplift", "cube": cube_path, **source, **options})

    return texture


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"wrap_mode": "mirror"},
        {"wrap_mode": "clamp"},
        {"filter_type": "nearest", "wrap_mode": "clamp"},
    ],
)
def test_filtering_agrees_with_mitsuba_s_bitmap(mi, texture, spectrum, sensor, options):
    import drjit

    ours = texture(**options)
    image = {"bitmap": mi.Bitmap(IMAGE), "raw": True}
    theirs = mi.load_dict({"type": "bitmap", **image, **options})
    si = drjit.zeros(mi.SurfaceInteraction3f)
    for uv in POSITIONS:
        si.uv = mi.Point2f(*uv)
        found = sensor.rgb(spectrum(ours, uv, sensor.wavelengths))
        assert_allclose(found, np.array(theirs.eval_3(si)), rtol=0, atol=1e-5)


def test_only_encoded_files_are_decoded_and_layers_are_read(
    mi, texture, spectrum, small_cube, tmp_path
):
    codes = np.array([[[200, 30, 90]]], dtype=np.uint8)
    linear = small_cube.decode(codes).astype(np.float32)
    mi.Bitmap(codes).write(str(tmp_path / "image.png"))
    layer = {f"paint.{name}": plane for name, plane in planes(linear).items()}
    write_exr(tmp_path / "image.exr", {**layer, "Z": np.ones((1, 1), np.float32)})
    expected = small_cube.reflectance(linear[0, 0], AT, mode="refined")
    for name in ("image.png", "image.exr"):
        found = texture(None, filename=str(tmp_path / name))
        assert_allclose(spectrum(found, (0.5, 0.5), AT), expected, atol=1e-5)


def test_colours_outside_are_mapped_with_a_warning(texture, spectrum, sensor):
    image = np.array([[[1.4, 0.2, -0.01], [0.1, 0.2, np.nan]]], dtype=np.float32)
    with warns("pixels-out-of-gamut", "pixels-not-finite", "texture-in-python"):
        found = texture(image, filter_type="nearest", out_of_gamut="scale")
    mapped = map_to_gamut(image[0, 0], sensor, "scale").rgb
    for u, expected in ((0.25, mapped), (0.75, [0.1, 0.2, 0])):
        rgb = sensor.rgb(spectrum(found, (u, 0.5), sensor.wavelengths))
        assert_allclose(rgb, expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize(
    ("factor", "options", "message"),
    [
        (1, {"wrap_mode": "round"}, "unknown wrap_mode 'round'"),
        (2, {"out_of_gamut": "error"}, "set the property out_of_gamut to clip"),
    ],
)
def test_invalid_properties_raise(texture, factor, options, message):
    with pytest.raises(RuntimeError, match=message):
        texture(factor * IMAGE, **options)


def test_the_stochastic_filter_chooses_texels_by_their_weights(texture, spectrum):
    image = np.repeat(np.float32([[[0.1], [0.8]]]), 3, axis=-1)
    found = texture(image, filter_type="stochastic", wrap_mode="clamp")
    at = np.linspace(500, 600, 1000)
    values = np.array(spectrum(found, (0.35, 0.5), at))  # weights 0.8 and 0.2
    assert set(values.round(1)) == {0.1, 0.8}
    assert (values < 0.4).mean() == pytest.approx(0.8, abs=0.05)


FILTERS = ("bilinear", "nearest", "stochastic")
WRAPS = ("repeat", "mirror", "clamp")
EVALUATE = """
import json, sys
import drjit, mitsuba as mi, numpy as np
from uplift.extras.mitsuba import register
properties, positions = map(json.loads, sys.argv[1:])
found = []
for variant, size in (("scalar_spectral", 1), ("llvm_ad_spectral", len(positions))):
    mi.set_variant(variant)
    register()
    for each in properties:
        texture = mi.load_dict({"type": "uplift", **each})
        for first in range(0, len(positions), size):
            si = drjit.zeros(mi.SurfaceInteraction3f, size)
            rows = np.float32(positions[first:first + size]).T
            si.uv = mi.Point2f(*(rows if size > 1 else rows[:, 0].tolist()))
            si.wavelengths = mi.Spectrum(400, 500, 600, 700)
            found += np.array(texture.eval(si)).reshape(4, -1).T.tolist()
print(json.dumps(found))
"""


def test_a_wavefront_agrees_with_single_rays(mi, small_cube, cube_path, tmp_path):
    """Of an image, and of textures of moments and of spectra."""
    need(LLVM)
    image = write_exr(tmp_path / "image.exr", planes(IMAGE))
    sources = [{"cube": cube_path, "filename": str(image)}]
    for encoding in (textures.Moments(), textures.Spectrum()):
        target = tmp_path / f"{encoding.name}.exr"
        textures.convert(textures.prepare(small_cube, encoding), image, target)
        sources.append({"filename": str(target)})
    properties = [
        {"filter_type": filter_type, "wrap_mode": wrap, **source}
        for source, filter_type, wrap in itertools.product(sources, FILTERS, WRAPS)
    ]
    arguments = [json.dumps(each) for each in (properties, POSITIONS)]
    values = np.array(json.loads(run_python(EVALUATE, *arguments)))
    assert_allclose(*np.split(values, 2), rtol=0, atol=1e-5)


# Two of them lie beyond the samples, and none halfway between samples that differ much.
WAVELENGTHS = np.array([362.5, 402.5, 555, 650, 823])


@pytest.mark.parametrize(
    ("encoding", "mode", "within"),
    [
        (textures.Spectrum(), "spectra", 1e-3),
        (textures.Moments(), "moments", 1e-4),
        (textures.Multipliers(), "refined", 1e-5),
    ],
    ids=["spectrum", "moments", "multipliers"],
)
def test_a_texture_has_the_spectra_of_the_cube(
    mi, spectrum, small_cube, tmp_path, encoding, mode, within
):
    image = write_exr(tmp_path / "image.exr", planes(IMAGE))
    uplifter = textures.prepare(small_cube, encoding, depth="float")
    path = textures.convert(uplifter, image, tmp_path / "texture.exr").target
    nearest = {"type": "uplift", "filter_type": "nearest", "filename": str(path)}
    found = spectrum(mi.load_dict(nearest), (0.4, 0.9), WAVELENGTHS)
    expected = small_cube.reflectance(IMAGE[2, 1], WAVELENGTHS, mode=mode)
    assert_allclose(found, expected, rtol=0, atol=within)


def flat(values, pattern="T.{},000000nm"):
    """Channels of one value each, by number."""
    return {
        pattern.format(number): np.full((2, 2), value, np.float32)
        for number, value in values.items()
    }


def grey(second=0.0):
    """Moments of a grey, and another second moment."""
    values = {"00": 0.5, "01": second} | {f"{order:02}": 0.0 for order in range(2, 9)}
    return flat(values, "moment.{}")


MODEL = {"uplift.model": json.dumps(Moments(9).describe())}


@pytest.mark.parametrize(
    ("channels", "header"),
    [
        (flat({400: 1, 500: 1, 700: 1}), {}),
        (flat({400: np.nan, 500: np.nan}), {}),
        (grey(), {}),
        (grey(), {"uplift.model": "{"}),
        (grey(0.6), MODEL),
    ],
)
def test_invalid_textures_raise(tmp_path, channels, header):
    path = write_exr(tmp_path / "texture.exr", channels, **header)
    with raises(TextureError):
        read_texels(path)


@pytest.mark.parametrize(
    "model",
    [Moments(9), Moments(3), Moments(17, 400, 700, "vision"), Sigmoid(400, 700)],
    ids=str,
)
def test_blend_is_the_weighted_sum(mi, model):
    at = [340.0, 401.5, 555.0, 820.0]
    multipliers = np.random.default_rng(2).normal(size=(3, model.count))
    weights = [0.5, 0.2, 0.3]
    found = blend(model, multipliers.tolist(), weights, mi.Spectrum(*at))
    expected = weights @ evaluate(model, multipliers, at)
    assert_allclose(np.array(found), expected, rtol=0, atol=1e-5)
