"""Fuzz target: the metadata of cubes, with a valid digest: values of any type, depth and size."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from safetensors.numpy import save_file

from tests.cube.cube_files import forge, forged_json
from tests.fuzz.cube_valid_digest import SEEDS
from tests.fuzz.mutate import Random
from tests.fuzz.target import Target
from uplift.common.errors import CubeFileError
from uplift.cube import container, file
from uplift.lookup import load
from uplift.pipeline.options import Options, recorded_options
from uplift.pipeline.rebuild import recorded_atlas
from uplift.report.summary import summarise

TEXTS = (
    "", "grey", "../macbeth.txt", "/etc/shadow", "/proc/kmsg", "/dev/zero", "macbeth.txt", "a/b", "..", "\0", "\n",
    "\x1b]0;t\x07", "\x1b]52;c;aGk=\x07", "\u202e", "\u2028", "[/]", "$\\frac{A$", "=1+1",
    "moments", "D65", "x" * 1000, "x" * 100_000,
)  # fmt: skip
NUMBERS = (
    0, 1, -1, 3.0, 1e-13, 5e-324, 1e308, -1e308, 0.1, 2**31, 2**63, 10**400, float("nan"), float("inf"),
)  # fmt: skip
DEPTHS = (1, 2, 3, 20, 27, 33, 300)


def _value(random: Random) -> Any:
    """Return a value of a random type."""
    kind = random.integers(7)
    if kind == 0:
        return TEXTS[random.integers(len(TEXTS))]
    if kind == 1:
        return NUMBERS[random.integers(len(NUMBERS))]
    if kind == 2:
        return [None, True, False, [], {}][random.integers(5)]
    if kind == 3:
        return [_value(random) for _ in range(random.integers(4))]
    if kind == 4:
        return {TEXTS[random.integers(len(TEXTS))]: _value(random) for _ in range(random.integers(4))}
    if kind == 5:
        return [TEXTS[random.integers(len(TEXTS) - 2)]] * int(random.choice([64, 65, 100_000]))
    value: Any = 1
    for _ in range(DEPTHS[random.integers(len(DEPTHS))]):
        value = {"a": value} if random.random() < 0.5 else [value]
    return value


def _change(metadata: dict[str, Any], random: Random) -> None:
    """Replace, remove or add a value anywhere."""
    place: Any = metadata
    while True:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        if not keys:
            break
        key = keys[random.integers(len(keys))]
        if not isinstance(place[key], dict | list) or random.random() < 0.3:
            _replace(place, key, random)
            return
        place = place[key]
    if isinstance(place, dict):
        place[TEXTS[random.integers(len(TEXTS))]] = _value(random)
    else:
        place.append(_value(random))


def _replace(place: Any, key: Any, random: Random) -> None:
    if random.random() < 0.1:
        del place[key]
    else:
        place[key] = _value(random)


def _generate(random: Random, path: Path) -> None:
    def change(tensors: dict[str, Any], metadata: dict[str, Any]) -> None:
        if random.random() < 0.7:
            metadata = metadata["provenance"]
        for _ in range(int(random.integers(1, 3))):
            _change(metadata, random)

    seed = SEEDS[random.integers(len(SEEDS))]
    if random.random() < 0.9:
        forge(seed, path, change)
        return
    tensors, metadata = file.contents(seed)
    text = forged_json(metadata).replace('"sRGB"', '"\\ud800"', 1)  # a lone surrogate has no digest
    save_file(tensors, path, metadata={container.KEY: text})


def _use(path: Path) -> None:
    """Read the cube and do all that a rebuild and 'uplift info' do before they compute."""
    data = load(path).data
    json.dumps(summarise(data), allow_nan=False)
    recorded_atlas(data, path)
    options = data.provenance.get("options")
    if not options:
        raise CubeFileError("no options")
    try:
        Options(**recorded_options(options))
    except TypeError as error:  # an unknown option, which a rebuild reports
        raise CubeFileError("unknown options") from error


TARGET = Target("cube, metadata", _generate, _use)
