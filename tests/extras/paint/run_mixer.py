"""Run exported mixers: each function takes a program, pairs of colours (n, 2, 3) and
shares (n,), and returns mixtures (n, 3).

It skips the test if the compiler, the browser or Node.js is lacking.
"""

import base64
import json

import numpy as np

from tests.extras.export.run_program import run_c, shade
from tests.helpers import output_of
from tests.parts import NODE, need

HOST = """
#include <stdio.h>
#include "paint.h"

int main(void)
{
    float given[7], result[9];
    while (fread(given, sizeof given, 1, stdin) == 1) {
        const float parts[2] = {1 - given[6], given[6]};
        paint_mix(given, given + 3, given[6], result);
        paint_mix_n(given, parts, 2, result + 3);
        paint_mix_srgb(given, given + 3, given[6], result + 6);
        fwrite(result, sizeof result, 1, stdout);
    }
    return 0;
}
"""
BYTES = """
#include <stdio.h>
#include "paint.h"

int main(void)
{
    unsigned char given[6], mixed[6];
    while (fread(given, sizeof given, 1, stdin) == 1) {
        paint_mix_bytes(given, given + 3, 0, mixed);
        paint_mix_bytes(given, given + 3, 1, mixed + 3);
        fwrite(mixed, sizeof mixed, 1, stdout);
    }
    return 0;
}
"""
MODULE = """
import { readFileSync } from "node:fs";
import { mix, mixAll, mixSrgb } from "./paint.mjs";
const pairs = JSON.parse(readFileSync(0, "utf8"));
console.log(JSON.stringify(pairs.map(([first, second, share]) => [
  mix(first, second, share),
  mixAll([first, second], [1 - share, share]),
  mixSrgb(first, second, share),
])));
"""
FRAGMENT = """#version 300 es
{code}
uniform sampler2D colours, seconds;
out vec4 found;
void main() {{
    vec4 first = texelFetch(colours, ivec2(gl_FragCoord.xy), 0);
    vec3 second = texelFetch(seconds, ivec2(gl_FragCoord.xy), 0).rgb;
    found = vec4(paint_mix(first.rgb, second, first.a), 1.0);
}}
"""
UPLOAD = """
  upload(3, "seconds", side, side, floats(data.seconds));
  gl.activeTexture(gl.TEXTURE2);
  gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA16F, data.dim, data.dim, 4 * data.dim, 0,
    gl.RGBA, gl.HALF_FLOAT, new Uint16Array(bytes(table).buffer));
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(gl.TEXTURE_3D, side, gl.LINEAR);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
    gl.texParameteri(gl.TEXTURE_3D, side, gl.CLAMP_TO_EDGE);
  gl.uniform1i(gl.getUniformLocation(program, "paint_table"), 2);
"""


def c(path, pairs, shares, compiler="c"):
    """Return results (n, 3, 3) of mixing two, n, and codes."""
    given = np.column_stack([pairs.reshape(-1, 6), shares]).astype(np.float32)
    return run_c(path, HOST, given, compiler).reshape(-1, 3, 3)


def ends_of_bytes(path, pairs):
    """Return codes (n, 2, 3) at both ends of mixtures of codes (n, 2, 3)."""
    return run_c(path, BYTES, pairs.astype(np.uint8)).reshape(-1, 2, 3)


def js(path, pairs, shares):
    """Return results (n, 3, 3) of mixing two, n, and codes, by Node.js."""
    need(NODE)
    main = path.with_name("main.mjs")
    main.write_text(MODULE)
    given = [
        [*pair, share]
        for pair, share in zip(pairs.tolist(), shares.tolist(), strict=True)
    ]
    return np.array(json.loads(output_of("node", main, input=json.dumps(given))))


def glsl(path, pairs, shares, dim):
    """Return mixtures (n, 3), whose number is a square."""
    first = np.column_stack([pairs[:, 0], shares])
    second = np.column_stack([pairs[:, 1], shares])
    table = base64.b64encode(path.with_suffix(".bin").read_bytes()).decode()
    seconds = base64.b64encode(second.astype(np.float32).tobytes()).decode()
    data = {"table": table, "seconds": seconds, "dim": dim}
    return shade(path, FRAGMENT, first, UPLOAD, **data)[:, :3]
