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
WITHIN = 1e-5  # tolerance of linear RGB in single precision


@pytest.fixture
def texture(mi, cube_path):
    """Function that makes a texture, by default of `IMAGE`."""

    def texture(image=IMAGE, **options):
        return mi.load_dict(
            {"type": "uplift", "cube": cube_path, "bitmap": mi.Bitmap(image), **options}
        )

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
    reference = mi.load_dict(
        {"type": "bitmap", "bitmap": mi.Bitmap(IMAGE), "raw": True, **options}
    )
    si = drjit.zeros(mi.SurfaceInteraction3f)
    for uv in POSITIONS:
        si.uv = mi.Point2f(*uv)
        found = sensor.rgb(spectrum(ours, uv, sensor.wavelengths))
        assert_allclose(found, np.array(reference.eval_3(si)), rtol=0, atol=WITHIN)


def test_a_texel_of_an_entry_s_colour_has_the_entry_s_spectrum(
    texture, spectrum, small_cube
):
    """The other texels of the image keep theirs, though they have more multipliers than
    without the entry.
    """
    atlas = small_cube.data.atlas
    image = np.array([[atlas.rgb[3], [0.01, 0.01, 0.2]]], dtype=np.float32)
    found = texture(image, filter_type="nearest")
    entry = small_cube.data.atlas.spectra.reflectance(
        np.array([3]), np.array([450.0, 650.0])
    )[0]
    assert_allclose(spectrum(found, (0.25, 0.5), [450, 650]), entry, atol=1e-5)
    other = small_cube.reflectance(image[0, 1], [450, 650], mode="refined")
    assert_allclose(spectrum(found, (0.75, 0.5), [450, 650]), other, atol=1e-5)


def test_texels_of_an_entry_outside_the_space_have_its_spectrum(
    mi, spectrum, cyan_cube, tmp_path
):
    """A bitmap, an OpenEXR file and a colour; beyond the entry a colour is mapped."""
    cyan_cube.save(tmp_path / "cyan.uplift")
    at = np.array([450.0, 650.0])
    rgb = cyan_cube.data.atlas.outside.rgb[0]
    entry = cyan_cube.data.atlas.outside.spectra.reflectance(np.array([0]), at)[0]
    pixels = np.array([[rgb, [1, 0.2, 0]]], dtype=np.float32)
    write_exr(tmp_path / "image.exr", planes(pixels))
    every = {"type": "uplift", "cube": str(tmp_path / "cyan.uplift")}
    nearest = every | {"filter_type": "nearest", "out_of_gamut": "error"}
    for source in (
        {"bitmap": mi.Bitmap(pixels)},
        {"filename": str(tmp_path / "image.exr")},
    ):
        assert_allclose(
            spectrum(mi.load_dict(nearest | source), (0.25, 0.5), at), entry, atol=1e-5
        )
    colour = ", ".join(map(repr, rgb.tolist()))
    assert_allclose(
        spectrum(mi.load_dict(every | {"rgb": colour}), (0.5, 0.5), at),
        entry,
        atol=1e-5,
    )
    pixels[0, 0] = rgb - [0.5, 0, 0]
    with warns("pixels-out-of-gamut", "texture-in-python"):
        found = mi.load_dict(
            every | {"bitmap": mi.Bitmap(pixels), "filter_type": "nearest"}
        )
    mapped = cyan_cube.reflectance(pixels[0, 0].clip(0, 1), at, mode="refined")
    assert_allclose(spectrum(found, (0.25, 0.5), at), mapped, atol=1e-5)


def test_only_encoded_files_are_decoded_and_layers_are_read(
    mi, spectrum, small_cube, tmp_path, cube_path
):
    codes = np.array([[[200, 30, 90]]], dtype=np.uint8)
    linear = small_cube.decode(codes).astype(np.float32)
    mi.Bitmap(codes).write(str(tmp_path / "image.png"))
    layer = {f"paint.{name}": linear[..., index] for index, name in enumerate("RGB")}
    write_exr(tmp_path / "image.exr", {**layer, "Z": np.ones((1, 1), np.float32)})
    expected = small_cube.reflectance(linear[0, 0], [450, 650], mode="refined")
    for name in ("image.png", "image.exr"):
        found = mi.load_dict(
            {"type": "uplift", "cube": cube_path, "filename": str(tmp_path / name)}
        )
        assert_allclose(spectrum(found, (0.5, 0.5), [450, 650]), expected, atol=1e-5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"wrap_mode": "round"}, "unknown wrap_mode 'round'"),
        (
            {"image": 2 * IMAGE, "out_of_gamut": "error"},
            "set the property out_of_gamut to clip",
        ),
        ({"out_of_gamut": "ignore"}, "unknown .*'ignore'"),
    ],
)
def test_invalid_properties_raise(texture, options, message):
    with pytest.raises(RuntimeError, match=message):
        texture(**options)


@pytest.mark.parametrize(
    ("options", "expected"), [({}, [1, 0.2, 0]), ({"out_of_gamut": "scale"}, None)]
)
def test_colours_outside_are_mapped_with_a_warning(
    texture, spectrum, sensor, options, expected
):
    image = np.array([[[1.4, 0.2, -0.01], [0.1, 0.2, np.nan]]], dtype=np.float32)
    with warns("pixels-out-of-gamut", "pixels-not-finite", "texture-in-python"):
        found = texture(image, filter_type="nearest", **options)
    rgb = [
        sensor.rgb(spectrum(found, (u, 0.5), sensor.wavelengths)) for u in (0.25, 0.75)
    ]
    first = (
        map_to_gamut(image[0, 0], sensor, "scale").rgb if expected is None else expected
    )
    assert_allclose(rgb, [first, [0.1, 0.2, 0]], rtol=0, atol=1e-4)


def test_the_stochastic_filter_chooses_texels_by_their_weights(texture, spectrum):
    image = np.array([[[0.1, 0.1, 0.1], [0.8, 0.8, 0.8]]], dtype=np.float32)
    found = texture(image, filter_type="stochastic", wrap_mode="clamp")
    values = np.array(
        spectrum(found, (0.35, 0.5), np.linspace(500, 600, 1000))
    )  # weights 0.8 and 0.2
    assert set(values.round(1)) == {0.1, 0.8}
    assert (values < 0.4).mean() == pytest.approx(0.8, abs=0.05)


OPTIONS = [
    {"filter_type": filter_type, "wrap_mode": wrap_mode}
    for filter_type, wrap_mode in itertools.product(
        ("bilinear", "nearest", "stochastic"), ("repeat", "mirror", "clamp")
    )
]

JIT = """
import json, sys
import drjit, mitsuba as mi, numpy as np
from uplift.extras.mitsuba import register
mi.set_variant("llvm_ad_spectral")
register()
sources, options, positions = map(json.loads, sys.argv[1:])
image = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
found = []
for source in sources:
    for each in options:
        properties = dict(source)
        if "filename" not in source:
            properties["bitmap"] = mi.Bitmap(image)
        texture = mi.load_dict({"type": "uplift", **properties, **each})
        si = drjit.zeros(mi.SurfaceInteraction3f, len(positions))
        si.uv = mi.Point2f(*np.array(positions, dtype=np.float32).T)
        si.wavelengths = mi.Spectrum(400, 500, 600, 700)
        found.append(np.array(texture.eval(si)).T.tolist())
print(json.dumps(found))
"""


def test_a_wavefront_agrees_with_single_rays(mi, small_cube, cube_path, tmp_path):
    need(LLVM)
    import drjit

    sources = [{"cube": cube_path}, *_textures(small_cube, tmp_path)]
    arguments = [json.dumps(each) for each in (sources, OPTIONS, POSITIONS)]
    found = json.loads(run_python(JIT, *arguments))
    expected = []
    for source in sources:
        for options in OPTIONS:
            bitmap = {} if "filename" in source else {"bitmap": mi.Bitmap(IMAGE)}
            texture = mi.load_dict({"type": "uplift", **source, **bitmap, **options})
            values = []
            for uv in POSITIONS:
                si = drjit.zeros(mi.SurfaceInteraction3f)
                si.uv = mi.Point2f(*uv)
                si.wavelengths = mi.Spectrum(400, 500, 600, 700)
                values.append(np.array(texture.eval(si)))
            expected.append(values)
    assert_allclose(found, expected, rtol=0, atol=1e-5)


def _textures(cube, folder):
    """Write the image as textures of moments and of spectra."""
    source = write_exr(folder / "image.exr", planes(IMAGE))
    for name, encoding in (
        ("moments", textures.Moments()),
        ("spectrum", textures.Spectrum()),
    ):
        target = folder / f"{name}.exr"
        textures.convert(textures.prepare(cube, encoding), source, target)
        yield {"filename": str(target)}


# Two of them lie beyond the samples, and none halfway between samples that differ much.
WAVELENGTHS = np.array([362.5, 402.5, 555, 650, 823])


def flat(value, *wavelengths):
    return {
        f"T.{at},000000nm": np.full((2, 2), value, np.float32) for at in wavelengths
    }


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
    write_exr(tmp_path / "image.exr", planes(IMAGE))
    uplifter = textures.prepare(small_cube, encoding, depth="float")
    textures.convert(uplifter, tmp_path / "image.exr", tmp_path / "texture.exr")
    found = mi.load_dict(
        {
            "type": "uplift",
            "filename": str(tmp_path / "texture.exr"),
            "filter_type": "nearest",
        }
    )
    expected = small_cube.reflectance(IMAGE[2, 1], WAVELENGTHS, mode=mode)
    assert_allclose(
        spectrum(found, (0.4, 0.9), WAVELENGTHS), expected, rtol=0, atol=within
    )


MODEL = {"uplift.model": json.dumps(Moments(9).describe())}
GREY = {
    f"moment.{order:02}": np.full((2, 2), 0.5 * (order == 0), np.float32)
    for order in range(9)
}


@pytest.mark.parametrize(
    ("channels", "header"),
    [
        (flat(1, 400, 500, 700), {}),
        (flat(np.nan, 400, 500), {}),
        (GREY, {}),
        (GREY, {"uplift.model": "{"}),
        ({**GREY, "moment.01": np.full((2, 2), 0.6, np.float32)}, MODEL),
        (None, MODEL),
    ],
)
def test_invalid_textures_raise(tmp_path, channels, header):
    path = write_exr(
        tmp_path / "texture.exr", GREY if channels is None else channels, **header
    )
    if channels is None:
        path.write_bytes(path.read_bytes()[:-20])
    with raises(TextureError):
        read_texels(path)


SAMPLED = [340.0, 401.5, 555.0, 820.0]
MODELS = [
    Moments(9),
    Moments(3),
    Moments(17, 400, 700, "vision"),
    Sigmoid(),
    Sigmoid(400, 700),
]


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_blend_is_the_weighted_sum(mi, model):
    multipliers = np.random.default_rng(2).normal(size=(3, model.count))
    weights = [0.5, 0.2, 0.3]
    found = blend(model, multipliers.tolist(), weights, mi.Spectrum(*SAMPLED))
    expected = weights @ evaluate(model, multipliers, SAMPLED)
    assert_allclose(np.array(found), expected, rtol=0, atol=1e-5)
