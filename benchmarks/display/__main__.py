"""Gamut mapping of Munsell chips outside sRGB: ``make display`` writes docs/data/display.json and a picture."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from benchmarks.display.munsell import Chips, chips, differences
from benchmarks.display.picture import MAPPINGS, draw
from benchmarks.display.spaces import ACESCG, SPACES, concavity, desaturate
from benchmarks.record import ROOT, write
from uplift.colorimetry.gamut import SRGB, map_to_gamut
from uplift.common.arrays import Array
from uplift.lab.timing import Spread, time_calls

PICTURE = ROOT / "docs" / "display" / "ways.png"
TIMED = 1 << 16
"""Colours, all of them outside."""
RUNS = 7
FAMILIES = ("R", "YR", "Y", "GY", "G", "BG", "B", "PB", "P", "RP")


def main() -> None:
    """Draw, measure and store."""
    warnings.simplefilter("ignore")  # colour-science warns about undefined values in some spaces
    draw(PICTURE)
    found = chips()
    mapped = {name: map_to_gamut(found.rgb, SRGB, name).rgb for name in MAPPINGS}
    write(
        "display",
        "make display",
        precision="full",
        chips=len(found.hues),
        runs=RUNS,
        timed=TIMED,
        methods=[{"name": name, **errors(found, rgb), "ns": cost(name)} for name, rgb in mapped.items()],
        families=families(found, mapped),
        spaces=[
            {
                "name": space.name,
                **errors(found, desaturate(space, found.rgb)),
                "srgb": concavity(space, SRGB),
                "acescg": concavity(space, ACESCG),
            }
            for space in SPACES
        ],
    )


def errors(found: Chips, mapped: Array) -> dict[str, Any]:
    """Return statistics of the hue shift, |ΔL*| and ΔE00 of mapped colours."""
    delta_e, lightness = differences(found, mapped)
    values = {"hue": found.hue_shift(mapped), "lightness": lightness, "delta_e": delta_e}
    return {
        name: {"mean": each.mean(), "p95": np.percentile(each, 95), "largest": each.max()}
        for name, each in values.items()
    }


def families(found: Chips, mapped: dict[str, Array]) -> list[dict[str, Any]]:
    """Return the mean hue shift by the hue of the chips."""
    names = np.array([hue.lstrip("0123456789.") for hue in found.hues])
    shifts = {method: found.hue_shift(rgb) for method, rgb in mapped.items()}
    return [
        {
            "hue": name,
            "chips": int((names == name).sum()),
            **{method: shift[names == name].mean() for method, shift in shifts.items()},
        }
        for name in FAMILIES
    ]


def cost(method: str) -> Spread:
    """Return the CPU time per mapped colour in nanoseconds."""
    rgb = np.random.default_rng(0).normal(0.5, 1, (3 * TIMED, 3))
    rgb = rgb[((rgb < 0) | (rgb > 1)).any(axis=1)][:TIMED]
    map_to_gamut(rgb, SRGB, method)
    _, cpu = time_calls(lambda: map_to_gamut(rgb, SRGB, method), RUNS)
    return cpu.scaled(1e9 / TIMED)


if __name__ == "__main__":
    main()
