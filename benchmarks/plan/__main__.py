"""``make plan`` → docs/plan.md."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.page import table, write
from benchmarks.plan.full import Case, Found, found
from benchmarks.plan.introduction import INTRODUCTION
from benchmarks.textures.pictures import pictures
from benchmarks.timing import ROOT

IN_FULL = "astronaut"
"""The scene whose candidates are shown."""
PICTURE = ROOT / "docs" / "plan" / "page.png"


CASES = (
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 1.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 2.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 0.5),
    Case("coffee.png", "macbeth.txt", ("D65", "A", "FL2", "FL11", "LED-B3"), 1.0),
    Case("chelsea.png", "babelcolor.txt", ("D50", "FL11"), 1.0),
)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for picture in pictures():
            shutil.copy(picture.path, folder)
        made = [found(folder, case) for case in CASES]
        _shoot(folder / f"{IN_FULL}-1.plan.html")
    print(write("plan", INTRODUCTION, _sections(made)))


def _sections(made: list[Found]) -> list[str]:
    full = next(each for each in made if Path(each.case.picture).stem == IN_FULL)
    return [_confirmed(made), *(_candidates(decision) for decision in full.plan["decisions"])]


def _confirmed(made: list[Found]) -> str:
    rows = []
    for each in made:
        error, share = each.plan["error"], each.plan["scene"]["quantile"]
        by = {
            key: float(np.quantile(values, share, method="inverted_cdf"))
            for key, values in each.apart.items()
        }
        full, predicted = max(by.values()), error["predicted"]["quantile"]
        group, light = max(by, key=lambda key: by[key])
        build, texture = each.plan["build"], each.plan["texture"]
        rows.append(
            [
                each.case.picture,
                each.case.atlas,
                ", ".join(each.case.lights),
                f"{each.case.tolerance:g}",
                f"{build['dim']}³ × {build['coefficients']}, {each.plan['cells']}",
                str(len(each.plan["rendering"]["wavelengths"])),
                f"{texture['form']}, {texture['depth']}",
                f"{predicted:.3f}",
                f"{error['confirmed']['quantile']:.3f}",
                f"{full:.3f}",
                f"{full / predicted - 1:+.1%}",
                f"{group}, {light}",
                f"{each.seconds:.0f} s",
            ]
        )
    head = ["texture", "atlas", "lights", "tolerated", "cube", "wavelengths", "a pixel"]
    head += ["predicted", "confirmed", "in full", "off by", "of", "CPU"]
    words = (
        "ΔE00 that 97.5 % stay within, of pixels or materials under the worst light. *Predicted* by the plan, "
        "*confirmed* by the plan on other pixels, and *in full* by an independent computation: the plan's lines run "
        "as processes, every pixel of the texture read by OpenEXR, spectra of the best cube (128³ × 17, float, 81 "
        "wavelengths) and measured materials integrated by colour-science, and its ΔE00. *Off by* is the last against "
        "the first. *CPU* seconds are those of `uplift plan`, start and compilation included."
    )
    return table("Predicted, and so", words, head, rows)


def _candidates(decision: dict[str, Any]) -> str:
    rows = []
    for number, trial in enumerate(decision["trials"]):
        error, taken = trial["error"], number == decision["taken"]
        name = f"**{trial['name']}**" if taken else trial["name"]
        numbers = [f"{error[key]:.3f}" for key in ("quantile", "mean", "largest")]
        rows.append([name, trial["told"], *numbers, f"{error['group']}, {error['light']}"])
    words = (
        f"{IN_FULL.capitalize()}, ΔE00 1 tolerated: the least that stays within ΔE00 {decision['limit']:g} so far, in "
        "bold."
    )
    return table(decision["title"], words, ["", "cost", "ΔE00, 97.5 %", "mean", "largest", "of"], rows)


def _shoot(page: Path) -> None:
    """A picture of a plan's page, where there is a browser to take it."""
    browser = shutil.which("chromium")
    if browser is None:
        return
    PICTURE.parent.mkdir(exist_ok=True)
    words = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--screenshot={PICTURE}"]
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([browser, *words, "--window-size=1180,1500", page.as_uri()], **quiet)


if __name__ == "__main__":
    main()
