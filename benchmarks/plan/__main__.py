"""Plans for real images, checked by an independent computation: ``make plan`` writes docs/data/plan.json."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.plan.full import Case, CheckedPlan, check_plan
from benchmarks.record import ROOT, write
from benchmarks.textures.pictures import pictures
from uplift.scene.plan import SearchGrid

PICTURE = ROOT / "docs" / "plan" / "page.png"
CASES = (
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 1.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 2.0),
    Case("astronaut.png", "macbeth.txt", ("D65", "FL11"), 0.5),
    Case("coffee.png", "macbeth.txt", ("D65", "A", "FL2", "FL11", "LED-B3"), 1.0),
    Case("chelsea.png", "babelcolor.txt", ("D50", "FL11"), 1.0),
)
"""The decisions of the first case are shown."""


def main() -> None:
    """Plan, check and store."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for picture in pictures():
            shutil.copy(picture.path, folder)
        checked = [check_plan(folder, case) for case in CASES]
        _screenshot(folder / f"{CASES[0].stem}.plan.html")
    effort = SearchGrid()
    write(
        "plan",
        "make plan",
        precision="full",
        predicting=effort.predicting,
        confirming=effort.confirming,
        reference_dim=effort.reference,
        reference_coefficients=effort.coefficients[-1],
        scenes=[summary(each) for each in checked],
        decisions=[decision_figures(decision) for decision in checked[0].plan["decisions"]],
    )


def summary(checked: CheckedPlan) -> dict[str, Any]:
    """Return what a plan chose, its predicted error, and the independent one."""
    case, plan = checked.case, checked.plan
    error, quantile = plan["error"], plan["scene"]["quantile"]
    independent = {
        key: float(np.quantile(values, quantile, method="inverted_cdf")) for key, values in checked.delta_e.items()
    }
    group, light = max(independent, key=lambda key: independent[key])
    predicted, largest = error["predicted"]["quantile"], max(independent.values())
    build, texture = plan["build"], plan["texture"]
    return {
        "texture": case.picture,
        "atlas": case.atlas,
        "lights": case.lights,
        "tolerance": case.tolerance,
        "cube": f"{build['dim']}³ × {build['coefficients']}, {plan['cells']}",
        "wavelengths": len(plan["rendering"]["wavelengths"]),
        "pixel": f"{texture['form']}, {texture['depth']}",
        "predicted": predicted,
        "confirmed": error["confirmed"]["quantile"],
        "independent": largest,
        "deviation": largest / predicted - 1,
        "group": group,
        "light": light,
        "seconds": checked.seconds,
    }


def decision_figures(decision: dict[str, Any]) -> dict[str, Any]:
    """Return the candidates of a decision with their errors."""
    trials = []
    for number, trial in enumerate(decision["trials"]):
        error = trial["error"]
        trials.append(
            {
                "name": trial["name"],
                "cost": trial["told"],
                **{key: error[key] for key in ("quantile", "mean", "largest", "group", "light")},
                "chosen": number == decision["taken"],
            }
        )
    return {"title": decision["title"], "limit": decision["limit"], "trials": trials}


def _screenshot(page: Path) -> None:
    """Take a picture of the page of a plan if Chromium is installed."""
    browser = shutil.which("chromium")
    if browser is None:
        return
    PICTURE.parent.mkdir(exist_ok=True)
    words = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--screenshot={PICTURE}"]
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([browser, *words, "--window-size=1180,1500", page.as_uri()], **quiet)


if __name__ == "__main__":
    main()
