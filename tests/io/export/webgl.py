"""Run exported GLSL on colours in headless Chromium, by WebGL 2."""

import base64
import json

import numpy as np

from benchmarks.browser import browser

FRAGMENT = """#version 300 es
{code}
uniform sampler2D colours;
out vec4 found;
void main() {{
    found = cube_reflectances(texelFetch(colours, ivec2(gl_FragCoord.xy), 0).rgb, vec4({wavelengths}));
}}
"""
WEBGL = """(() => {
  const floats = text => new Float32Array(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  const { code, table, rows, columns, colours, side } = DATA;
  const gl = Object.assign(document.createElement("canvas"), { width: side, height: side }).getContext("webgl2");
  if (!gl || !gl.getExtension("EXT_color_buffer_float")) return null;
  const program = gl.createProgram();
  const vertex = `#version 300 es
    void main() { gl_Position = vec4(gl_VertexID == 1 ? 3. : -1., gl_VertexID == 2 ? 3. : -1., 0., 1.); }`;
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, code]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const upload = (unit, name, width, height, values) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    if (name) gl.uniform1i(gl.getUniformLocation(program, name), unit);
  };
  upload(2, "cube_table", columns, rows, floats(table));
  upload(0, "colours", side, side, floats(colours));
  upload(1, "", side, side, null);
  const target = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, side, side);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const found = new Float32Array(4 * side * side);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, found);
  let text = "";
  for (const byte of new Uint8Array(found.buffer)) text += String.fromCharCode(byte);
  return btoa(text);
})()"""


def run(path, rgba, wavelengths):
    """Return reflectances (side², 4) of colours (side², 4) at four wavelengths, given as text; None without WebGL 2."""
    table = path.with_suffix(".bin").read_bytes()
    data = {
        "code": FRAGMENT.format(code=path.read_text(), wavelengths=wavelengths),
        "table": base64.b64encode(table).decode(),
        "columns": 2048,
        "rows": len(table) // (2048 * 16),
        "colours": base64.b64encode(rgba.tobytes()).decode(),
        "side": int(np.sqrt(len(rgba))),
    }
    page = path.with_suffix(".html")
    page.write_text("<!doctype html><main aria-busy='false'></main>")
    with browser() as opened:
        opened.open(page)
        found = opened.evaluate(WEBGL.replace("DATA", json.dumps(data)))
    return None if found is None else np.frombuffer(base64.b64decode(found), np.float32).reshape(-1, 4)
