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
    "rgb", [COLOUR, np.array(COLOUR), "0.5, 0.25, 0.1", "0.5 0.25 0.1"]
)
@pytest.mark.parametrize("is_default", [True, False])
def test_a_colour_has_the_spectrum_of_the_cube(
    mi, cube_path, spectrum, small_cube, rgb, is_default
):
    texture = mi.load_dict(
        {"type": "uplift", "rgb": rgb, **({} if is_default else {"cube": cube_path})}
    )
    expected = (load() if is_default else small_cube).reflectance(COLOUR, WAVELENGTHS)
    assert_allclose(spectrum(texture, (0, 0), WAVELENGTHS), expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("tag", ["rgb", "string"])
def test_scenes_can_be_xml_and_cubes_are_found_by_the_file_resolver(
    mi, repository, tag
):
    mi.file_resolver().prepend(str(repository / "cubes"))
    colour = (
        f'<{tag} name="rgb" value="0.5, 0.25, 0.1"/><string name="cube" '
        'value="moments-8.uplift"/>'
    )
    texture = f'<texture type="uplift" name="reflectance">{colour}</texture>'
    scene = mi.load_string(
        f'<scene version="3.0.0"><bsdf type="diffuse">{texture}</bsdf></scene>'
    )
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


SUNSET = (3.0, 1.0, 0.2)
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
    return mi.load_dict(
        {"type": "uplift_envmap", "bitmap": mi.Bitmap(rgb), **properties}
    )


def test_colours_have_the_spectra_of_the_table(mi, table, sky, spectrum):
    light = mi.load_dict({"type": "uplift", "emission": True, "rgb": list(SUNSET)})
    exact = 450.0, 520.0, 600.0
    assert_allclose(
        spectrum(light, (0.5, 0.5), exact), table.spectrum(SUNSET, exact), rtol=1e-5
    )
    light = mi.load_dict({"type": "uplift", "emission": True, "bitmap": mi.Bitmap(sky)})
    for row, column in ((0, 0), (2, 3), (7, 15)):
        found = spectrum(light, ((column + 0.5) / 16, (row + 0.5) / 8), SAMPLED)
        assert_allclose(found, table.spectrum(sky[row, column], SAMPLED), rtol=1e-4)


def test_images_and_spectral_images_agree(mi, table, sky, spectrum, tmp_path):
    source = write_exr(tmp_path / "sky.exr", planes(sky))
    texture.convert(
        texture.prepare_lights(table, threads=1), source, tmp_path / "spectral.exr"
    )
    found = [
        spectrum(
            mi.load_dict({"type": "uplift", "emission": True, "filename": str(path)}),
            (0.2, 0.3),
            SAMPLED,
        )
        for path in (source, tmp_path / "spectral.exr")
    ]
    assert_allclose(*found, rtol=1e-5)


@pytest.mark.parametrize("degrees", [0, 70])
def test_an_environment_lies_as_mitsubas_does(mi, radiance, degrees):
    """Both show the same ramp; the shapes of their white spectra differ."""
    ramp = (1 + np.arange(8 * 16, dtype=np.float32).reshape(8, 16, 1)) * np.ones(
        3, np.float32
    )
    to_world = mi.ScalarTransform4f().rotate([1, 2, 3], degrees)
    ours = environment(mi, ramp, to_world=to_world, scale=2.0)
    theirs = mi.load_dict(
        {"type": "envmap", "bitmap": mi.Bitmap(ramp), "to_world": to_world}
    )
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(12, 3))
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
