"""Fuzz target: lines of colours, as 'uplift query' reads them, through every gamut mapping."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
from uplift_cli.params.colours import from_table

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from uplift.colorimetry.gamut import METHODS, map_to_gamut
from uplift.lookup import Cube, load

SEEDS = (
    b"r,g,b\n0.1,0.2,0.3\n0.5,0.5,0.5\n",
    b"#cc3319\n#fff\n123456\n",
    b"0.1 0.2 0.3 a name\r\n1;0;1\r\n",
    b"1e308,-1e308,5e-324\n1.4,0.3,-0.1\n1e300,0.5,1e-300\n",
)
TOKENS = (
    b",", b";", b"\t", b" ", b"\n", b"\r", b"\r\n", b"#", b'"', b"\0", b"\xff", b"\xef\xbb\xbf", b"\xe2\x80\xa8",
    b"\xef\xbc\x91", b"0" * 70_000, b"," * 999, b"\n" * 999, b"1e999", b"5e-324", b"-1e308", *NUMBERS,
)  # fmt: skip


@functools.cache
def _cube() -> Cube:
    return load(ROOT / "cubes" / "moments-8-macbeth.uplift")


def _generate(random: Random, path: Path) -> None:
    content = SEEDS[random.integers(len(SEEDS))]
    path.write_bytes(content if random.random() < 0.1 else mutate(content, random, TOKENS))


def _use(path: Path) -> None:
    cube = _cube()
    with path.open("rb") as file:
        for rgb in from_table(file, path.name, cube.data.sensor, encoded=False, bounded=False):
            for method in METHODS[1:]:
                mapped = map_to_gamut(rgb, cube.data.sensor, method).rgb
                if not ((mapped >= 0) & (mapped <= 1)).all():
                    raise ValueError(f"{method}: colours outside [0, 1]")
            clipped = map_to_gamut(rgb, cube.data.sensor, "clip").rgb
            if not np.array_equal(clipped, np.clip(rgb, 0, 1)):
                raise ValueError("clipping changed another channel")
            if not np.isfinite(cube.reflectance(clipped[:8])).all():
                raise ValueError("reflectances that are not finite")


TARGET = Target("colour table", _generate, _use)
