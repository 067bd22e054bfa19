"""Programs in C of many cubes: one per kind of cube is compiled, and reads sizes,
constants and table at run time.
"""

import functools
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from tests.compiling import compile_in
from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.extras.export.program import cube_program
from uplift.extras.export.program_table import make_table

READ = (
    "DIM",
    "LATTICE",
    "ENTRIES",
    "CELLS",
    "BINS",
    "LISTS",
    "BOXES",
    "PULL",
    "SCALES",
    "LUMINANCE",
    "FACETS",
)
READ += (
    "FACET_COUNT",
    "SAMPLES",
    "FIRST",
    "STEP",
    "MARGIN",
    "START",
    "END",
    "LOW",
    "SCALE",
)
"""Constants that are read: the code of the program does not depend on them."""
MAIN = """#include <stdio.h>
#include "cube.h"
int main(void)
{
    float rgb[3], at[WAVELENGTHS], found[WAVELENGTHS];
    int size;
    READ_ALL
    fread(&size, sizeof size, 1, stdin);
    cube_table = malloc(size * sizeof(float));
    if (!cube_table) return 1;
    if (fread(cube_table, sizeof(float), size, stdin) != (size_t)size) return 1;
    fread(at, sizeof at, 1, stdin);
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {
        cube_reflectances(rgb, at, WAVELENGTHS, found);
        fwrite(found, sizeof found, 1, stdout);
    }
    return 0;
}
"""
FOLDER = tempfile.TemporaryDirectory(prefix="uplift-programs-")


def c_reflectances(data: CubeData, mode: str, rgb: Array, wavelengths: Array) -> Array:
    """Return reflectances (n, N) of linear RGB (n, 3) by the program of a cube in C."""
    table = make_table(data, mode)
    text = cube_program(data, table, "c", mode, "cube", "file")
    text = re.sub(r"\A/\*.*?\*/", "", text, flags=re.DOTALL)  # it names the cube
    text = re.sub(
        r"static inline const char \*cube_load.*?\n}\n", "", text, flags=re.DOTALL
    )  # and its table
    names = [name for name in READ if name in table.constants]
    kinds = {
        name: "int" if isinstance(table.constants[name], int) else "float"
        for name in names
    }
    for name, kind in kinds.items():
        text = re.sub(rf"#define CUBE_{name} .*", f"static {kind} CUBE_{name};", text)
    reads = "".join(f"fread(&CUBE_{name}, 4, 1, stdin);" for name in names)
    main = MAIN.replace("READ_ALL", reads).replace("WAVELENGTHS", str(len(wavelengths)))
    given = [
        np.array(table.constants[name], np.int32 if kind == "int" else np.float32)
        for name, kind in kinds.items()
    ]
    given += [
        np.int32(table.numbers.size),
        table.numbers,
        wavelengths.astype(np.float32),
        rgb.astype(np.float32),
    ]
    done = subprocess.run(
        [_compiled(text, main)],
        input=b"".join(map(np.ndarray.tobytes, map(np.asarray, given))),
        capture_output=True,
        check=True,
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, len(wavelengths))


@functools.cache
def _compiled(text: str, main: str) -> Path:
    """Compile a program, once in this process."""
    folder = Path(tempfile.mkdtemp(dir=FOLDER.name))
    (folder / "cube.h").write_text(text)
    (folder / "main.c").write_text(main)
    return compile_in(folder, "cc", "-std=c99", "-O1", "-w")
