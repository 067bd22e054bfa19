"""Measured paints: recovery of K and S, mixtures of acrylics, recipes, programs and
pictures, for docs/guides/paints.md.
"""

import json
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, REFERENCE, Row, summary
from benchmarks.mixtures import Mixtures, acrylics, draw_ramps
from benchmarks.programs import compile_c, numbers
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.pages.html import resource
from uplift.extras.paint.optics import ramp
from uplift.extras.paint.paint_advice import advise_samples
from uplift.extras.paint.paint_fit import fit_paints
from uplift.extras.paint.paint_page import SCRIPTS, page, page_numbers
from uplift.extras.paint.paint_program import few_samples, write_program
from uplift.extras.paint.paint_samples import (
    MeasuredColours,
    MeasuredSpectra,
    PaintSamples,
)
from uplift.extras.paint.paints import Paints
from uplift.extras.paint.paints_file import read_paints
from uplift.extras.paint.recipes import PaintTarget, match
from uplift.extras.timing import stopwatch

INVENTED = read_paints(REFERENCE / "invented_paints.toml")
"""Paints of which the swatches of ``uplift samples`` are made."""
NM = INVENTED.wavelengths
NOISES = (0.0, 0.002, 0.01)
"""Standard deviation of reflectances."""
JUDGED = 400
TINTS = (4, 20)
"""Parts of white to one of a paint."""
SPLITS = 3
RECIPES = 60
"""Left-out mixtures whose recipes are searched."""
COUNTS = (5, 6, 8, 10, 12)
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno")
RUNS = 25
STEPS = 13
RAMPS = (
    ("deep blue", "lemon yellow"),
    ("titanium white", "deep blue"),
    ("warm red", "titanium white"),
    ("lemon yellow", "carbon black"),
)
FILMS = ("lemon yellow", "warm red", "deep blue")
DEPTHS = np.geomspace(0.05, 5, STEPS)
"""Thickness of films in mm."""


# --- recovery of invented paints ---


def recovery() -> Iterator[Row]:
    """Yield how well paints are recovered from opaque swatches with noise."""
    test = np.random.default_rng(1).dirichlet(np.full(len(INVENTED), 0.5), JUDGED)
    expected = opaque_colours(INVENTED, test)
    for noise in NOISES:
        for name, parts in swatches(len(INVENTED)).items():
            spectra = INVENTED.reflectance(parts)
            spread = np.random.default_rng(2).standard_normal(spectra.shape)
            measured = MeasuredSpectra(np.clip(spectra + noise * spread, 0, 1))
            fit = fit_paints(opaque_samples(INVENTED.names, parts, measured))
            yield {
                "samples": name,
                "count": len(parts),
                "noise": noise,
                **summary(opaque_errors(fit.paints, test, expected)),
                "expected": advise_samples(fit, count=1).error,
                **log_errors(fit.paints, INVENTED),
            }


def swatches(count: int) -> dict[str, Array]:
    """Return parts (n, P) of growing sets of swatches; the first paint is white."""
    alone = np.eye(count)
    white, *coloured = alone
    weak, weaker = (alone[1:] + parts * white for parts in TINTS)
    pairs = [first + second for first, second in combinations(coloured, 2)]
    return {
        "each paint alone": alone,
        "and a tint 1:4": np.concatenate([alone, weak]),
        "and tints 1:4, 1:20": np.concatenate([alone, weak, weaker]),
        "and pairs 1:1": np.concatenate([alone, weak, weaker, pairs]),
    }


def opaque_samples(
    paints: Sequence[str], parts: Array, measured: MeasuredSpectra | MeasuredColours
) -> PaintSamples:
    """Return opaque samples of parts (n, P) of paints."""
    count = len(parts)
    shares = parts / parts.sum(axis=1, keepdims=True)
    opaque = np.full(count, np.inf)
    grounds = np.ones((count, len(NM)))
    names = ("",) * count
    return PaintSamples(names, tuple(paints), shares, opaque, grounds, NM, measured)


def opaque_colours(paints: Paints, parts: Array) -> Array:
    """Return linear RGB (n, 3) of opaque mixtures."""
    return np.clip(paints.sensor.rgb(paints.reflectance(parts)), 0, 1)


def opaque_errors(paints: Paints, parts: Array, expected: Array) -> Array:
    """Return ΔE00 (n,) of opaque mixtures from linear RGB (n, 3)."""
    return delta_e_rgb(paints.sensor, expected, opaque_colours(paints, parts))


def log_errors(paints: Paints, truth: Paints) -> Row:
    """Return the root mean square of errors of log K and log S, and the fraction within
    one standard error.

    A factor common to all paints at a wavelength, which opaque mixtures do not show, is
    left out.
    """
    assert paints.errors is not None
    found, expected, spreads = (
        np.stack([pigments.absorption, pigments.scattering])
        for pigments in (paints.pigments, truth.pigments, paints.errors)
    )
    errors = np.log(found / expected)
    errors -= errors[1].mean(axis=0)
    within = np.abs(errors) <= spreads
    return {"log_errors": np.sqrt((errors**2).mean()), "within": within.mean()}


# --- acrylics by colours ---


@cache
def fit_acrylics(split: int) -> tuple[Paints, Mixtures, float]:
    """Fit 19 acrylics to their colours and a third of their mixtures, as 8-bit codes;
    return the other mixtures and the seconds, too.
    """
    mixtures = acrylics()
    order = np.random.default_rng(split).permutation(len(mixtures.pairs))
    third = len(order) // 3
    known = mixtures.take(order[:third])
    count = len(mixtures.paints)
    colours = np.concatenate([mixtures.paints, known.expected])
    rounded = decode(np.rint(255 * encode(colours)) / 255)
    names = [f"paint {number}" for number in range(count)]
    parts = np.concatenate([np.eye(count), known.parts])
    samples = opaque_samples(names, parts, MeasuredColours(rounded))
    fit, run = stopwatch(lambda: fit_paints(samples))
    return fit.paints, mixtures.take(order[third:]), run.wall


def acrylic_fits() -> Iterator[Row]:
    """Yield the errors of the mixtures that a fit does not know, by split."""
    for split in range(SPLITS):
        paints, others, seconds = fit_acrylics(split)
        errors = opaque_errors(paints, others.parts, others.expected)
        known = len(acrylics().pairs) - len(errors)
        yield {"known": known, **summary(errors), "seconds": seconds}


def recipes() -> Row:
    """Search the recipes of left-out mixtures, whose colours are all that is known."""
    paints, others, _ = fit_acrylics(0)
    wanted = others.take(np.arange(RECIPES))
    found = np.zeros_like(wanted.parts)
    spectra = uplift.load().reflectance(wanted.expected, NM)
    for row, spectrum in enumerate(spectra):
        goal = PaintTarget(spectrum, (paints.sensor.light,))
        (recipe, *_) = match(goal, paints, count=2, alternatives=1)
        indices = [paints.index(name) for name in recipe.paints]
        found[row, indices] = np.array(recipe.parts) / sum(recipe.parts)
    is_right = ((found > 0) == (wanted.parts > 0)).all(axis=1)
    off = np.abs(found - wanted.parts).max(axis=1)
    return {
        "right": is_right.mean(),
        "share_error": off[is_right].mean(),
        **summary(opaque_errors(paints, found, wanted.expected)),
    }


# --- programs ---


def both_paints() -> dict[str, Paints]:
    """Return the invented paints and the acrylics."""
    return {"invented": INVENTED, "acrylics": fit_acrylics(0)[0]}


def few_wavelengths() -> Iterator[Row]:
    """Yield the errors of opaque mixtures and of layers at few wavelengths."""
    for name, paints in both_paints().items():
        for count in COUNTS:
            few = few_samples(paints, count)
            about = {"paints": name, "count": count}
            yield {**about, "coat": "opaque", **summary(few.opaque_errors)}
            yield {**about, "coat": "layers", **summary(few.layer_errors)}


RECIPE_TIME = """
const goalOf = i => [30 + 5 * i, 40 * Math.cos(i), 40 * Math.sin(i)];
const goals = Array.from({ length: 8 }, (_, i) => goalOf(i));
recipesFor(goals[0], 3);
const begin = performance.now();
for (const goal of goals) recipesFor(goal, 3);
console.log((performance.now() - begin) / goals.length / 1e3);
"""


def programs() -> Iterator[Row]:
    """Yield the size of the header in C, millions of mixtures a second, and the seconds
    of a recipe of three paints in Node.js.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for paints in both_paints().values():
            header = folder / "mixer.h"
            write_program(paints, header, force=True)
            source = Path(__file__).with_suffix(".c")
            seconds, _ = numbers(compile_c(source, folder, *FLAGS), str(RUNS))
            script = folder / "recipes.mjs"
            script.write_text(page_script(paints) + RECIPE_TIME, encoding="utf-8")
            (recipe,) = numbers("node", script)
            yield {
                "paints": len(paints),
                "header": header.stat().st_size,
                "rate": 1e-6 / seconds,
                "recipe": recipe,
            }


def page_script(paints: Paints) -> str:
    """Return the scripts of the page of paints without those that show it."""
    content = json.dumps(json.dumps(page_numbers(paints)))
    kernels = [name for name in SCRIPTS if not name.endswith("page.js")]
    element = f"{{ textContent: {content} }}"
    stub = f"globalThis.document = {{ getElementById: () => ({element}) }};"
    return f"{stub}\n{resource(*kernels)}\n"


def pictures() -> None:
    """Draw ramps of paints, and films on white and on black; write their page."""
    paints = INVENTED
    folder = DOCS / "mixing"
    (folder / "paints.html").write_text(page(paints), encoding="utf-8")
    alone = dict(zip(paints.names, np.eye(len(paints)), strict=True))
    shares = ramp(np.ones(2), STEPS)
    ramps = {}
    for first, second in RAMPS:
        parts = shares @ [alone[first], alone[second]]
        ramps[f"{first} to {second}"] = paints.sensor.rgb(paints.reflectance(parts))
    draw_ramps(ramps, folder / "paints.png")
    films = {}
    for ground, name in ((1.0, "white"), (0.0, "black")):
        for paint in FILMS:
            title = f"{paint} on {name}, {DEPTHS[0]:g} to {DEPTHS[-1]:g} mm"
            layers = [paints.reflectance(alone[paint], x, ground) for x in DEPTHS]
            films[title] = paints.sensor.rgb(np.array(layers))
    draw_ramps(films, folder / "films.png")


QUESTIONS = {
    "recovery": recovery,
    "acrylics": acrylic_fits,
    "recipes": recipes,
    "few_wavelengths": few_wavelengths,
    "programs": programs,
    "pictures": pictures,
}
