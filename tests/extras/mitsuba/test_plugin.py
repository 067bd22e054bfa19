"""Scene descriptions of colours and of lights: properties, defaults, errors, and the
environment.
"""

import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.extras import texture
from uplift.extras.emission.lookup import load_emission
from uplift.extras.mitsuba.plugin import register
from uplift.lookup.cube import load

pytestmark = pytest.mark.filterwarnings("ignore:.*calls Python for every ray")
COLOUR = [0.5, 0.25, 0.1]
WAVELENGTHS = np.arange(362.5, 830, 50)


@pytest.mark.parametrize(
    ("rgb", "is_default"),
    [
        (COLOUR, True),
        (np.array(COLOUR), False),
        ("0.5, 0.25, 0.1", False),
        ("0.5 0.25 0.1", False),
    ],
)
def test_a_colour_has_the_spectrum_of_the_cube(
    mi, cube_path, spectrum, small_cube, rgb, is_default
):
    chosen = {} if is_default else {"cube": cube_path}
    texture = mi.load_dict({"type": "uplift", "rgb": rgb, **chosen})
    cube = load() if is_default else small_cube
    expected = cube.reflectance(COLOUR, WAVELENGTHS)
    assert_allclose(spectrum(texture, (0, 0), WAVELENGTHS), expected, rtol=0, atol=1e-4)


SCENE = """<scene version="3.0.0"><bsdf type="diffuse">
<texture type="uplift" name="reflectance"><{} name="rgb" value="0.5, 0.25, 0.1"/>
<string name="cube" value="moments-8.uplift"/></texture></bsdf></scene>"""


@pytest.mark.parametrize("tag", ["rgb", "string"])
def test_scenes_can_be_xml_and_cubes_are_found_by_the_file_resolver(
    mi, repository, tag
):
    mi.file_resolver().prepend(str(repository / "cubes"))
    scene = mi.load_string(SCENE.format(tag))
    assert "RegularSpectrum" in str(scene)


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({}, "must have one of rgb, filename, bitmap, got 0"),
        ({"rgb": "red"}, "rgb must be three numbers, got 'red'"),
        ({"rgb": [0.5, 0.5, 2.0]}, r"lies outside \[0, 1\]"),
        ({"rgb": COLOUR, "cube": "missing.uplift"}, "missing.uplift: "),
        ({"rgb": COLOUR, "wrap": "clamp"}, "unreferenced"),
        ({"filename": "missing.png"}, "No such file"),
        ({"rgb": COLOUR, "out_of_gamut": "ignore"}, "unknown .*'ignore'"),
        ({"type": "uplift_envmap"}, "must have one of filename, bitmap"),
        ({"emission": True, "rgb": "-3, 1, -2"}, "no light has the colour"),
        (
            {"emission": True, "rgb": "1, 1, 1", "cube": "missing.uplift"},
            "missing.uplift",
        ),
    ],
)
def test_invalid_properties_raise(mi, properties, message):
    with pytest.raises(RuntimeError, match=message):
        mi.load_dict({"type": "uplift", **properties})


def test_a_variant_without_spectra_raises(mi):
    mi.set_variant("scalar_rgb")
    try:
        with raises(OptionError, "option"):
            register()
    finally:
        mi.set_variant("scalar_spectral")


def test_missing_mitsuba_raises(monkeypatch):
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    with raises(OptionError, "extra-not-installed"):
        register()


SAMPLED = (450.0, 520.5, 600.0)


@pytest.fixture(scope="module")
def table():
    return load_emission()


@pytest.fixture(scope="module")
def sky():
    """Linear RGB (8, 16, 3): a gradient with a bright spot."""
    rows, columns = np.mgrid[0:8, 0:16]
    rgb = np.stack([0.2 + rows / 8, 0.5 + columns / 32, 1.0 - rows / 10], axis=-1)
    rgb[2, 3] = (900.0, 800.0, 500.0)
    return rgb.astype(np.float32)


@pytest.fixture
def radiance(mi):
    """Function that evaluates the radiance (N,) of an emitter along a direction."""
    import drjit

    def radiance(emitter, direction, wavelengths):
        si = drjit.zeros(mi.SurfaceInteraction3f)
        si.wi = -mi.Vector3f(direction)
        found = []
        for wavelength in wavelengths:
            si.wavelengths = mi.Spectrum(float(wavelength))
            found.append(emitter.eval(si)[0])
        return np.array(found)

    return radiance


def environment(mi, rgb, **properties):
    image = {"bitmap": mi.Bitmap(rgb)}
    return mi.load_dict({"type": "uplift_envmap", **image, **properties})


def light(mi, **properties):
    return mi.load_dict({"type": "uplift", "emission": True, **properties})


def test_colours_have_the_spectra_of_the_table(mi, table, sky, spectrum):
    sunset = [3.0, 1.0, 0.2]
    exact = 450.0, 520.0, 600.0
    found = spectrum(light(mi, rgb=sunset), (0.5, 0.5), exact)
    assert_allclose(found, table.spectrum(sunset, exact), rtol=1e-5)
    image = light(mi, bitmap=mi.Bitmap(sky))
    for row, column in ((0, 0), (2, 3), (7, 15)):
        found = spectrum(image, ((column + 0.5) / 16, (row + 0.5) / 8), SAMPLED)
        assert_allclose(found, table.spectrum(sky[row, column], SAMPLED), rtol=1e-4)


def test_images_and_spectral_images_agree(mi, table, sky, spectrum, tmp_path):
    source = write_exr(tmp_path / "sky.exr", planes(sky))
    converter = texture.prepare_lights(table, threads=1)
    spectral = texture.convert(converter, source, tmp_path / "spectral.exr").target
    found = [
        spectrum(light(mi, filename=str(path)), (0.2, 0.3), SAMPLED)
        for path in (source, spectral)
    ]
    assert_allclose(*found, rtol=1e-5)


@pytest.mark.parametrize("degrees", [0, 70])
def test_an_environment_lies_as_mitsubas_does(mi, radiance, degrees):
    """Both show the same ramp; the shapes of their white spectra differ."""
    ramp = np.arange(1, 129, dtype=np.float32).reshape(8, 16, 1).repeat(3, axis=-1)
    turned = {"to_world": mi.ScalarTransform4f().rotate([1, 2, 3], degrees)}
    ours = environment(mi, ramp, scale=2.0, **turned)
    theirs = mi.load_dict({"type": "envmap", "bitmap": mi.Bitmap(ramp), **turned})
    directions = np.random.default_rng(0).normal(size=(12, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    levels = np.array([radiance(ours, list(way), [560.0]) for way in directions])
    expected = np.array([radiance(theirs, list(way), [560.0]) for way in directions])
    ratios = levels / expected
    assert_allclose(ratios, ratios.mean(), rtol=1e-3)
    assert levels.max() > 2 * levels.min()


def test_samples_are_radiance_over_density(mi, sky, radiance, monkeypatch):
    import drjit

    # Mitsuba keeps the names of a variant that was set earlier, which refuse emitters
    # of scalar variants.
    monkeypatch.setattr(mi, "EmitterPtr", None, raising=False)
    scene = mi.load_dict(
        {"type": "scene", "sky": environment(mi, sky), "ball": {"type": "sphere"}}
    )
    (emitter,) = scene.emitters()
    it = drjit.zeros(mi.SurfaceInteraction3f)
    it.wavelengths = mi.Spectrum(550.0)
    it.wi = mi.Vector3f(0, 0, 1)
    for sample in ((0.05, 0.2), (0.4, 0.5), (0.85, 0.3)):
        ds, weight = emitter.sample_direction(it, mi.Point2f(*sample))
        expected = radiance(emitter, ds.d, [550.0])[0]
        assert_allclose(weight[0] * ds.pdf, expected, rtol=1e-4)
        assert_allclose(emitter.pdf_direction(it, ds), ds.pdf, rtol=1e-3)
        assert_allclose(emitter.eval_direction(it, ds)[0], expected, rtol=1e-4)
        wavelengths, weight = emitter.sample_wavelengths(it, sample[0])
        expected = radiance(emitter, [0, 0, -1], list(wavelengths))
        assert_allclose(weight * mi.pdf_rgb_spectrum(wavelengths), expected, rtol=1e-4)
