"""Run ``uplift.js`` with cube files, in node."""

import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from tests.extras.export.run_header import FOLDER, Answers, run
from tests.parts import NODE, need
from uplift.extras.export.module import write_module
from uplift.lookup.cube import Cube

MAIN = """
import { readFileSync, writeSync } from "node:fs";
import { open } from "./uplift.mjs";

function result(answer) {
  try {
    answer();
    return 0;
  } catch (error) {
    if (!error.result) throw error;
    return error.result;
  }
}

const [path, size, n] = process.argv.slice(2);
const width = Number(size);
const cube = await open(readFileSync(path)).catch(error => process.exit(error.result));
const given = new Float32Array(Uint8Array.from(readFileSync(0)).buffer);
const at = given.subarray(0, width);
const stride = 4 + 2 + 17 + width;
const rows = new Float32Array(n * stride);
for (let i = 0; i < n; ++i) {
  const rgb = given.subarray(width + 3 * i, width + 3 * i + 3);
  const row = rows.subarray(i * stride, (i + 1) * stride);
  const results = new Int32Array(row.buffer, row.byteOffset, 4);
  results[0] = result(() => row.set(cube.reflectances(rgb, at), 23));
  results[1] = result(() => row.set(cube.standardError(rgb), 4));
  results[2] = result(() => row.set(cube.errorBound(rgb), 5));
  results[3] = result(() => row.set(cube.coefficients(rgb), 6));
}
const bytes = new Uint8Array(rows.buffer);
for (let at = 0; at < bytes.length; ) at += writeSync(1, bytes, at);
"""


def module_answers(cube: Cube, rgb: np.ndarray, at: np.ndarray) -> Answers:
    """Save a cube and read it by the module."""
    return run(["node", program()], cube, rgb, at)


def module_result(path: Path) -> int:
    """Return the result of opening a file."""
    command = ["node", program(), path, "0", "0"]
    return subprocess.run(command, stdin=subprocess.DEVNULL).returncode


@cache
def program() -> Path:
    """Write the program and the module."""
    need(NODE)
    folder = Path(tempfile.mkdtemp(dir=FOLDER.name))
    write_module(folder / "uplift.mjs")
    path = folder / "main.mjs"
    path.write_text(MAIN)
    return path
