"""What textures are worth: ``make textures`` → docs/textures.md and docs/textures/relit.png."""

from __future__ import annotations

import sys
import time
import warnings

import uplift
from benchmarks.page import write
from benchmarks.textures.introduction import INTRODUCTION
from benchmarks.timing import ROOT

PICTURES = ROOT / "docs" / "textures"


def main() -> None:
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    # First: what starts from a large process counts that one's memory as its own.
    from benchmarks.textures import speed

    begin = time.perf_counter()
    cube = ROOT / "cubes" / "moments-16-macbeth.uplift"
    timings = speed.section(str(cube))
    _tell("speed", begin)
    from benchmarks.textures import accuracy, relit
    from benchmarks.textures.pictures import pictures

    macbeth = uplift.build(ROOT / "atlases" / "macbeth.txt", dim=32)
    PICTURES.mkdir(exist_ok=True)
    apart = relit.draw(macbeth, next(iter(pictures())), PICTURES / "relit.png")
    sections = accuracy.sections(macbeth)
    _tell("accuracy", begin)
    told = ", ".join(f"{value:.1f} under {name}" for name, value in apart.items())
    print(write("textures", INTRODUCTION.format(apart=told), [*sections, timings]))


def _tell(what: str, begin: float) -> None:
    print(f"{what}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
