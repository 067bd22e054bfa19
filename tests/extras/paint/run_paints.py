"""Run exported paints: each function takes a program and rows (n, P + 2) of parts,
thickness and grey ground, and returns rows (n, 2 S + 3): opaque reflectances, those of
the layer, and linear RGB.

It skips the test if the compiler or the browser is lacking.
"""

import numpy as np

from tests.extras.export.run_program import run_c, shade

HOST = """
#include <stdio.h>
#include "tubes.h"

int main(void)
{
    float given[TUBES_PAINTS + 2], ground[TUBES_SAMPLES];
    float result[2 * TUBES_SAMPLES + 3];
    while (fread(given, sizeof given, 1, stdin) == 1) {
        for (int at = 0; at < TUBES_SAMPLES; ++at) ground[at] = given[TUBES_PAINTS + 1];
        tubes_opaque(given, result);
        tubes_layer(given, given[TUBES_PAINTS], ground, result + TUBES_SAMPLES);
        tubes_mix(given, result + 2 * TUBES_SAMPLES);
        fwrite(result, sizeof result, 1, stdout);
    }
    return 0;
}
"""
FRAGMENT = """#version 300 es
{code}
uniform sampler2D colours;
out vec4 found;
void main() {{
    vec4 given = texelFetch(colours, ivec2(gl_FragCoord.xy), 0);
    float parts[TUBES_PAINTS] = float[TUBES_PAINTS](2., 1., 0., .5);
    float ground[TUBES_SAMPLES], layer[TUBES_SAMPLES], rgb[3];
    for (int at = 0; at < TUBES_SAMPLES; ++at) ground[at] = given.b;
    tubes_layer(parts, given.a, ground, layer);
    tubes_rgb(layer, rgb);
    found = vec4(rgb[0], rgb[1], rgb[2], layer[3]);
}}
"""
PIXEL = """
{code}
StructuredBuffer<float4> colours : register(t1);
RWStructuredBuffer<float4> found : register(u2);
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {{
    float parts[TUBES_PAINTS] = {{1, 1, 1, 1}};
    float rgb[3];
    parts[0] = colours[id.x].x;
    tubes_mix(parts, rgb);
    found[id.x] = float4(rgb[0], rgb[1], rgb[2], 1);
}}
"""


def c(path, rows, compiler="c"):
    given = rows.astype(np.float32)
    return run_c(path, HOST, given, compiler).reshape(len(rows), -1)


def glsl(path, films):
    """Return linear RGB and the fourth reflectance (n, 4) of films (n, 2) of one
    mixture, of a thickness and on a grey ground, by WebGL 2 in Chromium.
    """
    return shade(path, FRAGMENT, films[:, [0, 0, 1, 0]])
