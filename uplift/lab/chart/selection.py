"""The methods of charts, their selection by name, and the stability of one."""

import warnings
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import Any

from uplift.atlas.sources import read_atlas
from uplift.colorimetry.sensor import Light
from uplift.common.errors import OptionError
from uplift.extras.colour.srgb import decode
from uplift.lab.chart.task import make_task
from uplift.lab.method import Method, NotInstalledError
from uplift.lab.methods import find_methods
from uplift.lab.study.sensitivity import COLOURS, perturb_answers

METHODS = tuple(find_methods())
QUICK_METHODS = (
    "jakob2019-*",
    "mallett2019",
    "otsu2018",
    "smits1999",
    "mitsuba3-llvm",
    "c-sigmoid-32-moments",
    "moments9-16*-spectra",
    "moments9-16*-moments",
    "moments9-64-spectra",
    "moments9-64-moments",
)
"""Patterns of the methods of a quick run."""


def select_methods(patterns: Sequence[str] = ()) -> list[Method]:
    """Select methods by name, by default all. Raises `OptionError`."""
    selected = set()
    for pattern in patterns or "*":
        matches = {
            method.method for method in METHODS if fnmatchcase(method.method, pattern)
        }
        if not matches:
            hint = (
                "names are 'mallett2019', 'moments9-32-spectra' and others; '*' "
                "matches any characters"
            )
            raise OptionError(f"no method matches '{pattern}'", hint=hint)
        selected |= matches
    return [method for method in METHODS if method.method in selected]


def perturb_method(
    method: Method, light: Light, count: int = COLOURS
) -> list[dict[str, Any]]:
    """Perturb queries of a method, in sRGB under D65, as
    `uplift.lab.study.sensitivity`. Raises `OptionError`.
    """
    task = make_task({"macbeth": read_atlas("macbeth")}).unseen
    lights = (light, task.sensor.light)
    # colour-science warns how it aligns wavelengths.
    with warnings.catch_warnings(action="ignore"):
        try:
            uplift = method.prepare(task).uplift
        except NotInstalledError as error:
            raise OptionError(
                f"{method.method} {error}", code="extra-not-installed"
            ) from error
        return perturb_answers(
            method.title,
            lambda rgb: uplift(rgb, task.sensor.wavelengths),
            lambda codes: decode(codes / 255),
            lights,
            count,
        )
