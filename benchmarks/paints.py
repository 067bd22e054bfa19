"""Measured paints: recovery of K and S, mixtures of acrylics, recipes, programs and a
picture, for docs/guides/paints.md.
"""

import json
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, ROOT, Row, record
from benchmarks.invented_paints import NM, invented_paints
from benchmarks.mixing import acrylics
from uplift.colorimetry import Sensor, delta_e_rgb, observer
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.pages.html import resource
from uplift.extras.pages.plots import Strip, plot_strips
from uplift.extras.paint import (
    PaintFit,
    Paints,
    PaintSamples,
    PaintTarget,
    advise_samples,
    fit_paints,
    match,
)
from uplift.extras.paint.paint_page import SCRIPTS, page_numbers, write_page
from uplift.extras.paint.paint_program import few_samples, write_program
from uplift.extras.paint.paint_samples import MeasuredColours, MeasuredSpectra

RANGE = (400.0, 700.0, 10.0)
NOISES = (0.0, 0.002, 0.01)
"""Standard deviation of reflectances."""
JUDGED = 400
SPLITS = 3
TINTS = (4, 20)
"""Parts of white to one of a paint."""
RECIPES = 60
"""Left-out mixtures whose recipes are searched."""
COUNTS = (5, 6, 8, 10, 12)
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno")
RUNS = 25
STEPS = 13


def opaque_samples(
    paints: Sequence[str], shares: Array, measured: MeasuredSpectra | MeasuredColours
) -> PaintSamples:
    """Return opaque samples of paints."""
    count = len(shares)
    names = tuple(f"sample {number}" for number in range(count))
    return PaintSamples(
        names,
        tuple(paints),
        shares / shares.sum(axis=1, keepdims=True),
        np.full(count, np.inf),
        np.ones((count, len(NM))),
        NM,
        measured,
    )


# --- recovery of invented paints ---


def recovery() -> Iterator[Row]:
    """Yield how well paints are recovered from samples with noise."""
    truth = invented_paints()
    count = len(truth)
    own = np.eye(count)
    tints = [own[1:] + parts * own[0] for parts in TINTS]
    pairs = [
        own[first] + own[second]
        for first in range(1, count)
        for second in range(first + 1, count)
    ]
    sets = {
        "each paint alone": own,
        "and a tint 1:4": np.concatenate([own, tints[0]]),
        "and tints 1:4, 1:20": np.concatenate([own, *tints]),
        "and pairs 1:1": np.concatenate([own, *tints, pairs]),
    }
    sensor = observer.sensor(wavelengths=RANGE)
    test = np.random.default_rng(1).dirichlet(np.full(count, 0.5), JUDGED)
    for noise in NOISES:
        for name, shares in sets.items():
            random = np.random.default_rng(2)
            spectra = truth.reflectance(shares)
            noisy = spectra + noise * random.standard_normal(spectra.shape)
            measured = MeasuredSpectra(np.clip(noisy, 0, 1))
            fit = fit_paints(opaque_samples(truth.names, shares, measured))
            advice = advise_samples(fit, count=1)
            errors = _log_errors(fit, truth)
            yield {
                "samples": name,
                "count": len(shares),
                "noise": noise,
                "mixtures": _spread(_differences(fit.paints, truth, test, sensor)),
                "expected": advice.error,
                "next": advice.samples[0].name,
                "log_errors": float(np.sqrt((errors**2).mean())),
                "coverage": _coverage(fit, errors),
                "inside": fit.paints.surface.inside,
            }


def _differences(paints: Paints, truth: Paints, parts: Array, sensor: Sensor) -> Array:
    colours = [
        np.clip(sensor.rgb(known.reflectance(parts)), 0, 1) for known in (paints, truth)
    ]
    return delta_e_rgb(sensor, *colours)


def _log_errors(fit: PaintFit, truth: Paints) -> Array:
    """Return the errors (2, P, N) of log K and log S, without a factor common to all
    paints at a wavelength, which opaque mixtures do not show.
    """
    pairs = (
        (fit.paints.pigments.absorption, truth.pigments.absorption),
        (fit.paints.pigments.scattering, truth.pigments.scattering),
    )
    errors = np.array([np.log(fitted / true) for fitted, true in pairs])
    return np.asarray(errors - errors[1].mean(axis=0))


def _coverage(fit: PaintFit, errors: Array) -> float:
    """Return the fraction of errors within one standard error."""
    expected = fit.paints.errors
    assert expected is not None
    spreads = np.array([expected.absorption, expected.scattering])
    return float((np.abs(errors) <= spreads).mean())


def _spread(errors: Array) -> Row:
    return {
        "mean": float(errors.mean()),
        "p95": float(np.quantile(errors, 0.95)),
        "max": float(errors.max()),
    }


# --- acrylics by colours ---


def acrylic_fits() -> tuple[list[Row], list[tuple[PaintFit, Indices]]]:
    """Fit 19 acrylics to their colours and a third of their mixtures, as 8-bit codes,
    and judge the others.
    """
    mixtures = acrylics()
    count = len(mixtures.paints)
    parts = np.zeros((len(mixtures.pairs), count))
    np.put_along_axis(parts, mixtures.pairs, mixtures.shares, axis=1)
    rows = list[Row]()
    fits = []
    for split in range(SPLITS):
        order = np.random.default_rng(split).permutation(len(parts))
        third = len(parts) // 3
        known, others = order[:third], order[third:]
        shares = np.concatenate([np.eye(count), parts[known]])
        colours = np.concatenate([mixtures.paints, mixtures.expected[known]])
        rounded = decode(np.rint(255 * encode(colours)) / 255)
        names = [f"paint {number}" for number in range(count)]
        samples = opaque_samples(names, shares, MeasuredColours(rounded))
        begin = time.perf_counter()
        fit = fit_paints(samples)
        seconds = time.perf_counter() - begin
        sensor = fit.model.sensor
        rgb = np.clip(sensor.rgb(fit.paints.reflectance(parts[others])), 0, 1)
        errors = delta_e_rgb(sensor, mixtures.expected[others], rgb)
        rows.append(
            {
                "known": third,
                "judged": len(others),
                "errors": _spread(errors),
                "inside": fit.paints.surface.inside,
                "seconds": seconds,
            }
        )
        fits.append((fit, others))
    return rows, fits


def recipes(fit: PaintFit, others: Indices) -> Row:
    """Search the recipes of left-out mixtures, whose colours are all that is known."""
    mixtures = acrylics()
    sensor = fit.model.sensor
    paints = fit.paints
    parts = np.zeros((len(mixtures.pairs), len(paints)))
    np.put_along_axis(parts, mixtures.pairs, mixtures.shares, axis=1)
    chosen = others[:RECIPES]
    cube = uplift.load()
    errors = []
    right = []
    ratios = []
    seconds = []
    for row in chosen:
        spectrum = cube.reflectance(mixtures.expected[row], NM)
        goal = PaintTarget(spectrum, (sensor.light,))
        begin = time.perf_counter()
        found = match(goal, paints, count=2, alternatives=1)[0]
        seconds.append(time.perf_counter() - begin)
        mixed = np.zeros(len(paints))
        for name, part in zip(found.paints, found.parts, strict=True):
            mixed[paints.index(name)] = part
        rgb = np.clip(sensor.rgb(paints.reflectance(mixed)), 0, 1)
        errors.append(float(delta_e_rgb(sensor, mixtures.expected[row], rgb)))
        is_right = set(np.flatnonzero(mixed)) == set(np.flatnonzero(parts[row]))
        right.append(is_right)
        if is_right:
            ratios.append(np.abs(mixed / mixed.sum() - parts[row]).max())
    return {
        "searched": len(chosen),
        "right": float(np.mean(right)),
        "errors": _spread(np.array(errors)),
        "share_error": float(np.mean(ratios)),
        "seconds": float(np.median(seconds)),
    }


# --- programs ---


def program_rates(paints: Paints) -> Row:
    """Return errors by number of wavelengths, and the rate in C."""
    rows = []
    for count in COUNTS:
        few = few_samples(paints, count)
        rows.append(
            {
                "count": count,
                "opaque": _spread(few.opaque_errors),
                "layers": _spread(few.layer_errors),
            }
        )
    return {"errors": rows, **_c_rate(paints)}


def _c_rate(paints: Paints) -> Row:
    compiler = shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        raise RuntimeError("the rate needs a compiler")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(paints, folder / "mixer.h")
        source = str(ROOT / "benchmarks" / "paints.c")
        command = [compiler, *FLAGS, "-I.", source, "-o", "rates", "-lm"]
        subprocess.run(command, cwd=folder, check=True)
        printed = subprocess.check_output(["./rates", str(RUNS)], cwd=folder, text=True)
        version = subprocess.check_output([compiler, "--version"], text=True)
        size = (folder / "mixer.h").stat().st_size
    return {
        "compiler": version.splitlines()[0],
        "flags": " ".join(FLAGS),
        "rate": 1e-6 / float(printed.split()[0]),
        "header": size,
        "paints": len(paints),
    }


PAGE_TIMES = """
const goalOf = i => [30 + 5 * i, 40 * Math.cos(i), 40 * Math.sin(i)];
const goals = Array.from({ length: 8 }, (_, i) => goalOf(i));
recipesFor(goals[0], 3);
let begin = performance.now();
for (const goal of goals) recipesFor(goal, 3);
const recipe = (performance.now() - begin) / goals.length;
begin = performance.now();
for (let i = 0; i < 20000; ++i) opaque([0, 1, 2], [1, i % 7, 2]);
console.log(recipe / 1e3, (performance.now() - begin) / 20000 / 1e3);
"""


def page_times(paints: Paints) -> Row:
    """Return seconds of a recipe of three paints and of a mixture in Node.js, by the
    scripts of the page.
    """
    numbers = json.dumps(json.dumps(page_numbers(paints)))
    stub = f"{{ getElementById: () => ({{ textContent: {numbers} }}) }}"
    kernels = [name for name in SCRIPTS if not name.endswith("page.js")]
    text = f"globalThis.document = {stub};\n{resource(*kernels)}\n{PAGE_TIMES}"
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "times.mjs"
        path.write_text(text, encoding="utf-8")
        printed = subprocess.check_output(["node", path], text=True).split()
    recipe, mixture = map(float, printed)
    return {"paints": len(paints), "recipe": recipe, "mixture": mixture}


# --- pictures ---


def draw(paints: Paints) -> None:
    """Draw ramps of paints, and films on white and on black; write their page."""
    write_page(paints, DOCS / "mixing" / "paints.html", force=True)
    sensor = observer.sensor(wavelengths=RANGE)
    ramp = np.linspace(0, 1, STEPS)[:, None]
    own = np.eye(len(paints))
    pairs = (
        ("deep blue", "lemon yellow"),
        ("titanium white", "deep blue"),
        ("warm red", "titanium white"),
        ("lemon yellow", "carbon black"),
    )
    strips = []
    for first, second in pairs:
        ends = own[[paints.index(first), paints.index(second)]]
        rgb = sensor.rgb(paints.reflectance((1 - ramp) * ends[0] + ramp * ends[1]))
        strips.append(Strip(f"{first} to {second}", encode(rgb)))
    plot_strips(strips, DOCS / "mixing" / "paints.png", force=True)
    strips = []
    depths = np.geomspace(0.05, 5, STEPS)
    for ground, name in ((1.0, "white"), (0.0, "black")):
        for paint in ("lemon yellow", "warm red", "deep blue"):
            parts = own[paints.index(paint)]
            films = [paints.reflectance(parts, depth, ground) for depth in depths]
            title = f"{paint} on {name}, {depths[0]:g} to {depths[-1]:g} mm"
            strips.append(Strip(title, encode(sensor.rgb(np.array(films)))))
    plot_strips(strips, DOCS / "mixing" / "films.png", force=True)


def main() -> None:
    """Measure, draw and store."""
    draw(invented_paints())
    fits, fitted = acrylic_fits()
    record(
        "paints",
        recovery=list(recovery()),
        acrylics=fits,
        recipes=recipes(*fitted[0]),
        programs=program_rates(invented_paints()),
        acrylic_program=program_rates(fitted[0][0].paints),
        browser=page_times(invented_paints()),
        acrylic_browser=page_times(fitted[0][0].paints),
    )
