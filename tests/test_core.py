"""The core alone: nine rooms, copied, build a cube, load it and query it."""

import shutil

from tests.helpers import run_python

CORE = (
    "common",
    "colorimetry",
    "models",
    "lattice",
    "atlas",
    "fit",
    "cube",
    "lookup",
    "pipeline",
)
PROGRAM = """
import sys
from uplift.common.errors import OptionError
from uplift.lookup.cube import load
from uplift.pipeline.build import build
cube = build("macbeth.txt", dim=8)
cube.save("built.uplift")
print(load("built.uplift").reflectance([0.8, 0.2, 0.1], [450, 650]).tolist())
try:
    build("macbeth.txt", dim=8, growth="neighbours")
except OptionError as error:
    print(error.code)
print(*sorted(name for name in sys.modules if name.startswith("uplift.")))
"""
OUTER = ("OpenImageIO", "OpenEXR", "PyOpenColorIO", "jinja2", "pydantic", "click")


def test_the_core_alone_builds_loads_and_queries(repository, tmp_path, cyan_cube):
    package = tmp_path / "uplift"
    package.mkdir()
    (package / "__init__.py").touch()
    for room in CORE:
        shutil.copytree(repository / "uplift" / room, package / room)
    shutil.copy(repository / "atlases" / "macbeth.txt", tmp_path)
    program = f"{PROGRAM}\nprint('outer:', *set(sys.modules) & {set(OUTER)})"
    answer, code, modules, outer = run_python(program, cwd=tmp_path).splitlines()

    assert answer == str(cyan_cube.reflectance([0.8, 0.2, 0.1], [450, 650]).tolist())
    assert code == "option"
    assert {name.split(".")[1] for name in modules.split()} == set(CORE)
    assert outer == "outer:"
