"""Writers that are killed, and builds at once: the old or a complete new file remains,
and cubes are equal.
"""

import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

import uplift
from tests.fuzz.fuzzing import ROOT
from uplift.cube.file import digest

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="needs SIGKILL and /proc"
)

OLD, NEW = (
    ROOT / "cubes" / f"{name}.uplift"
    for name in ("moments-16-macbeth", "sigmoid-16-macbeth")
)
SAVE_IN_TURN = """
import itertools, sys, uplift
cubes = [uplift.load(path) for path in sys.argv[2:]]
print(flush=True)
for cube in itertools.cycle(cubes):
    cube.save(sys.argv[1], force=True)
"""


@pytest.mark.parametrize("exists", [False, True])
def test_a_killed_writer_leaves_a_complete_file_or_none(tmp_path, exists):
    path = tmp_path / "cube.uplift"
    complete = {OLD.read_bytes(), NEW.read_bytes()}
    for turn in range(3):
        path.unlink(missing_ok=True)
        if exists:
            shutil.copy(OLD, path)
        with subprocess.Popen(
            [sys.executable, "-c", SAVE_IN_TURN, path, OLD, NEW], stdout=subprocess.PIPE
        ) as process:
            process.stdout.readline()
            time.sleep(0.02 * turn)
            process.kill()
        assert path.read_bytes() in complete if path.exists() else not exists
        for temporary in tmp_path.glob(".*.part"):
            os.utime(temporary, (0, 0))  # as if the process had been killed long ago
        uplift.load(NEW).save(path, force=True)
        assert os.listdir(tmp_path) == [path.name]


def test_builds_in_threads_give_equal_cubes():
    def built(dim: int) -> str:
        return digest(uplift.build(dim=dim, coefficients=5).data)

    alone = {dim: built(dim) for dim in (3, 4)}
    dims = [3, 4, 3]
    with ThreadPoolExecutor(len(dims)) as pool:
        assert list(pool.map(built, dims)) == [alone[dim] for dim in dims]
