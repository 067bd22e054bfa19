"""Fourier sRGB: tables from sRGB, and the shader of its spectra."""

import itertools
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import output_of
from tests.parts import CXX, GLSLANG, need
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.colour.srgb import decode
from uplift.extras.export import fourier, write_fourier
from uplift.models import reflectance

WAVELENGTHS = np.arange(370.0, 800.0, 10)
LEVEL = 4
HARNESS = """
#include <cmath>
#include <cstdio>
struct vec3 {{
    float x, y, z;
    vec3(float a, float b, float c) : x(a), y(b), z(c) {{}}
}};
static vec3 operator*(vec3 a, float s) {{ return vec3(a.x * s, a.y * s, a.z * s); }}
static vec3 operator/(vec3 a, float s) {{ return vec3(a.x / s, a.y / s, a.z / s); }}
static vec3 operator-(vec3 a, vec3 b) {{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}}
static float dot(vec3 a, vec3 b) {{ return a.x * b.x + a.y * b.y + a.z * b.z; }}
static float clamp(float x, float low, float high) {{
    return std::fmin(std::fmax(x, low), high);
}}
using std::sin; using std::cos; using std::tan; using std::tanh; using std::atan;
#include "{name}.glsl"
int main() {{
    float r, g, b, w;
    while (std::scanf("%f %f %f %f", &r, &g, &b, &w) == 4)
        std::printf(
            "%.9g\\n", {name}_reflectance({name}_multipliers(vec3(r, g, b)), w));
}}
"""


@pytest.fixture(scope="module")
def three():
    return uplift.build(dim=6, coefficients=3, warp="colour")


@pytest.fixture(scope="module")
def folder(three, tmp_path_factory):
    """Folder of a table, an image of 16³ codes, and their shaders."""
    folder = tmp_path_factory.mktemp("fourier")
    write_fourier(three, folder / "table.cube", res=9)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fourier, "LEVEL", LEVEL)
        write_fourier(three, folder / "hald.png")
    return folder


def hald(path):
    """Codes (16, 16, 16, 3) of the image, by red, green and blue."""
    from OpenImageIO import ImageBuf

    pixels = ImageBuf(str(path)).get_pixels("uint8")
    assert pixels.shape == (LEVEL**3, LEVEL**3, 3)
    return pixels.reshape(LEVEL**2, LEVEL**2, LEVEL**2, 3).transpose(2, 1, 0, 3)


def test_codes_have_the_colours_of_srgb(three, folder):
    """Of the spectra of 8-bit codes, which are also near the codes themselves."""
    codes = hald(folder / "hald.png").reshape(-1, 3)
    sensor = three.data.sensor
    nodes = np.linspace(0, 1, LEVEL**2)
    requested = np.array(list(product(nodes, repeat=3)))
    moments = decode(codes / 255) @ fourier._to_moments(three.data).T
    found = sensor.rgb(reflectance(three.data.model, moments, sensor.wavelengths))
    errors = delta_e_rgb(
        sensor, found, sensor.rgb(three.reflectance(decode(requested), mode="moments"))
    )
    assert errors.mean() < 0.3
    assert np.abs(codes - 255 * requested).mean() < 15
    greys = codes[:: 3 * (LEVEL**4 + LEVEL**2 + 1)]  # at nodes of the cube
    assert_allclose(greys, 255 * nodes[::3, None].repeat(3, axis=1), atol=1)


def test_the_table_has_the_codes_of_the_image(folder):
    lines = (folder / "table.cube").read_text().splitlines()
    assert lines[2] == "LUT_3D_SIZE 9"
    table = np.array([line.split() for line in lines[3:]], dtype=float).reshape(
        9, 9, 9, 3
    )  # by blue, green, red
    codes = hald(folder / "hald.png")
    for corner in product((0, 1), repeat=3):
        red, green, blue = (-axis for axis in corner)
        assert_allclose(
            255 * table[blue, green, red], codes[red, green, blue], atol=0.51
        )


def test_the_shader_evaluates_the_spectra(three, folder):
    """As C++, with filtered colours; components that no spectrum has keep to [0, 1]."""
    need(CXX)
    (folder / "main.cpp").write_text(HARNESS.format(name="hald"))
    output_of("c++", "-std=c++17", "main.cpp", "-o", "main", cwd=folder)

    def shader(colours):
        pairs = itertools.product(colours.tolist(), WAVELENGTHS.tolist())
        text = "\n".join(" ".join(map(repr, (*colour, nm))) for colour, nm in pairs)
        values = output_of(folder / "main", input=text).split()
        return np.array(values, dtype=float).reshape(len(colours), -1)

    codes = hald(folder / "hald.png")
    pairs = decode(codes[1:-1, 1:-1, 1:-1].reshape(-1, 2, 3)[::40] / 255)
    filtered = pairs.mean(axis=1)
    moments = filtered @ fourier._to_moments(three.data).T
    expected = reflectance(three.data.model, moments, WAVELENGTHS)
    assert_allclose(shader(filtered), expected, atol=2e-4)
    corners = shader(np.array(list(product((0.0, 1.0), repeat=3))))
    assert ((corners >= 0) & (corners <= 1)).all()


def test_the_shader_compiles(folder):
    need(GLSLANG)
    text = (folder / "hald.glsl").read_text()
    call = "hald_reflectance(hald_multipliers(vec3(0.5)), 500.0)"
    (folder / "a.frag").write_text(
        f"#version 430\n{text}out vec4 o; void main() {{ o = vec4({call}); }}\n"
    )
    output_of("glslangValidator", "a.frag", cwd=folder)
