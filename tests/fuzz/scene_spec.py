"""Fuzz targets: the readers of scene files and plans, with mutated TOML and JSON."""

from __future__ import annotations

import functools
import json
from dataclasses import asdict
from pathlib import Path

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from uplift.io.scene_colours import file_digest
from uplift.pipeline.options import Options
from uplift.scene.plan import read_plan, read_scene_file
from uplift.scene.plan.plan_file import FORMAT

ATLAS, TEXTURE = ROOT / "atlases" / "macbeth.txt", ROOT / "docs" / "plan" / "page.png"
SCENE_FILE = f"""# a kitchen
textures = ["{TEXTURE}", "{TEXTURE.parent}/*.png"]
atlases = "{ATLAS}"
lights = ["D65", "FL11"]
tolerance = 0.5
quantile = 0.9
""".encode()
TOKENS = (
    b"textures", b"atlases", b"lights", b"tolerance", b"quantile", b"encoding", b"space", b"illuminant", b"observer",
    b"format", b"scene", b"build", b"cells", b"path", b"digest", b"dim", b"axis", b"coefficients", b"D65", b"sRGB",
    b"..", b"/", b"*", b"**", b"[", b"]", b"{", b"}", b"[[", b"=", b":", b",", b'"', b"'", b'"""', b"\\", b"\\u0000",
    b"true", b"null", b"\n", b"\0", b"\xff", b"#", b"[" * 100_000, b'{"a":' * 20_000, b"a." * 2000, *NUMBERS,
)  # fmt: skip


@functools.cache
def _plan() -> bytes:
    """Make the part of a plan that its reader uses."""
    texture, atlas = ([{"path": str(path), "digest": file_digest(path)}] for path in (TEXTURE, ATLAS))
    plan = {
        "format": FORMAT,
        "scene": {"encoding": "auto", "textures": texture, "atlases": atlas},
        "build": asdict(Options(dim=8)),
        "cells": "sparse",
    }
    return json.dumps(plan, indent=40).encode()  # mostly blanks, so that some mutations leave it valid


def _generate_scene_file(random: Random, path: Path) -> None:
    path.write_bytes(mutate(SCENE_FILE, random, TOKENS))


def _generate_plan(random: Random, path: Path) -> None:
    path.write_bytes(mutate(_plan(), random, TOKENS))


def _use_scene_file(path: Path) -> None:
    """Read the file only, as planning takes half a minute."""
    read_scene_file(path).light_sources()


def _use_plan(path: Path) -> None:
    read_plan(path)


SCENE_FILES = Target("scene file", _generate_scene_file, _use_scene_file)
PLANS = Target("plan", _generate_plan, _use_plan)
