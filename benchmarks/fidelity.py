"""Spectra of cubes compared with measured spectra, for docs/materials.md and
docs/prior.md.
"""

from collections.abc import Iterator
from dataclasses import asdict
from functools import cache, partial
from itertools import chain, product, starmap
from typing import Any

import numpy as np

from benchmarks import Row, record
from benchmarks.choices import (
    ALONE,
    ALONE_SMOOTH,
    CHOICES,
    OURS,
    OURS_SMOOTH,
    is_optimistic,
)
from benchmarks.materials import (
    FETCHED,
    LARGE,
    MIXTURE,
    SENSOR,
    SPLITS,
    Materials,
    as_record,
    by_light,
    errors,
    inside,
    materials,
    other_halves,
    shipped_families,
    spectra,
)
from tools.ship_library import FAMILIES, FILE, OTSU_SPREAD, SPREAD
from uplift import build
from uplift.atlas import Atlas
from uplift.colorimetry import Light, delta_e_spectra, observer
from uplift.common.arrays import Array
from uplift.cube import contents
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.measures import check_calibration
from uplift.fit import shipped_library
from uplift.fit.families import LENGTH, NUGGET
from uplift.lab.chart.method import Uplift, make_task
from uplift.lab.chart.selection import select_methods
from uplift.lab.study import held_out
from uplift.lab.study.local_linear import local_linear
from uplift.lookup import Cube

DIM = 32
COARSE = 16
COUNTS = (9, 13, 17)
SETS = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017")
"""Shipped sets of at least 20 entries. The others are too small to split."""
SMALL = tuple(name for name in SETS if name not in LARGE)
TESTED = ("macbeth", "cie2017", "rawtoaces")
PARTS = (2, 4, 10)
"""Parts of the mixture, of which cubes know all but one."""
LIBRARY_SETS = tuple(chain.from_iterable(FAMILIES.values()))
PUBLISHED = ("otsu2018", "mallett2019", "smits1999")
Pairs = list[tuple[Cube, Materials]]
"""Cubes and the materials that they are queried for."""


def main() -> None:
    """Measure and store."""
    measure_coverage()
    record(
        "fidelity",
        "held-out",
        lights=list(HELD_OUT_LIGHTS),
        splits=SPLITS,
        choices=map(asdict, CHOICES),
        sets=map(compare_methods, (*SETS, *FETCHED, MIXTURE)),
    )
    record(
        "fidelity",
        "mixture",
        dim=DIM,
        splits=SPLITS,
        rows=map(learning_curve, PARTS),
    )
    measure_prior()


def measure_coverage() -> None:
    """Measure the errors at entries, and how many errors the stated ones cover."""
    cubes = [*product(LARGE, COUNTS), *((name, 9) for name in (*SMALL, MIXTURE))]
    standard_errors = []
    light_errors = []
    for name, count in cubes:
        pairs = other_halves(name, dim=DIM, coefficients=count)
        standard_errors.append(coverage(name, count, pairs))
        light_errors.append(
            {"atlas": name, "coefficients": count, "covered": covered(pairs)}
        )
    for name in LARGE:
        cube = build("macbeth", dim=DIM, leave_out=shipped_families(name))
        label = f"macbeth, queried for {name}"
        standard_errors.append(coverage(label, 9, [(cube, materials(name))]))
    record(
        "fidelity",
        dim=DIM,
        splits=SPLITS,
        munsell=bool(FETCHED),
        entries=chain.from_iterable(map(at_entries, TESTED)),
        standard_errors=standard_errors,
        light_errors=light_errors,
    )


def measure_prior() -> None:
    """Measure what the learnt prior gives for sets that it does not know."""
    sets = (*LIBRARY_SETS, *FETCHED)
    record(
        "fidelity",
        "prior",
        dim=COARSE,
        lights=list(HELD_OUT_LIGHTS),
        parameters={
            "length": LENGTH,
            "nugget": NUGGET,
            "spread": SPREAD,
            "otsu_spread": OTSU_SPREAD,
            "bytes": FILE.stat().st_size,
        },
        library=[
            {"name": known.name, "spectra": len(known.measured)}
            for known in shipped_library()
        ],
        unseen=starmap(unseen, product(sets, (9, 17))),
        atlases=[with_atlas(name) for name in sets if name not in FAMILIES["checker"]],
        libraries=chain.from_iterable(map(with_library, LARGE)),
    )


def at_entries(name: str) -> Iterator[Row]:
    """Yield the errors of cubes at the colours of entries, and the cubes' sizes."""
    entries = materials(name)
    of_atlas = partial(build, name, dim=DIM)
    cubes = {
        f"9 coefficients, entries {count}": of_atlas(entry_coefficients=count)
        for count in COUNTS
    }
    cubes |= {
        "17 coefficients": of_atlas(coefficients=17),
        "9, without the atlas": build(dim=DIM),
        "sigmoid": of_atlas(model="sigmoid"),
    }
    for label, cube in cubes.items():
        size = sum(array.nbytes for array in contents(cube.data)[0].values())
        yield {
            "atlas": name,
            "cube": label,
            "megabytes": size / 1e6,
            **errors(cube.reflectance(entries.rgb), entries),
        }


def pooled(splits: tuple[held_out.HoldoutSplit, ...], method: str) -> Array:
    """Return mean rms, then mean ΔE00 under each light, over the splits.

    Splits of one set differ by one entry at most.
    """
    return np.mean([split.errors[method].means() for split in splits], axis=0)


def stated(pairs: Pairs, light: Light) -> tuple[Array, Array]:
    """Return errors (3, n), actual, standard and bounds, and whether the latter two
    cover the first (n, 2).
    """
    parts = []
    for cube, queried in pairs:
        rgb = queried.rgb
        actual = delta_e_spectra(light, cube.reflectance(rgb), queried.measured)
        standard_error = cube.standard_error(rgb, light)
        parts.append([actual, standard_error, cube.error_bound(rgb, light)])
    pooled_errors = np.concatenate(parts, axis=1)
    return pooled_errors, (pooled_errors[0] <= pooled_errors[1:]).T


def coverage(label: str, count: int, pairs: Pairs) -> Row:
    """Return the coverage under the light of the nodes."""
    light = observer.light(pairs[0][0].data.error_illuminant)
    overall = check_calibration(*stated(pairs, light)[0])
    return {
        "atlas": label,
        "coefficients": count,
        "all": [overall.actual, overall.predicted],
        "within_error": overall.within_error,
        "within_bound": overall.within_bound,
    }


def covered(pairs: Pairs) -> dict[str, Array]:
    """Return the shares of errors within the standard error and the bound, by light."""
    return {
        name: stated(pairs, observer.light(name))[1].mean(axis=0)
        for name in HELD_OUT_LIGHTS
    }


def compare_methods(name: str) -> Row:
    """Return the errors of all methods on the held-out halves of a set."""
    left_out = shipped_families(name)
    learnt = held_out.holdout(spectra(name), SPLITS, leave_out=left_out)
    smooth = held_out.holdout(spectra(name), SPLITS, prior="smooth", leave_out=())
    results = {
        OURS: pooled(learnt, held_out.HALF),
        OURS_SMOOTH: pooled(smooth, held_out.HALF),
        held_out.LOCAL_LINEAR: pooled(learnt, held_out.LOCAL_LINEAR),
        ALONE: pooled(learnt, held_out.NO_ATLAS),
        ALONE_SMOOTH: pooled(smooth, held_out.NO_ATLAS),
        held_out.SIGMOID: pooled(learnt, held_out.SIGMOID),
    }
    queried = materials(name)
    for method, answers in published(queried).items():
        results[method] = means(answers, queried)
    least = min(values[1:].mean() for values in results.values())
    rows = [
        {
            "method": method,
            **as_record(values),
            "mean": values[1:].mean(),
            "best": values[1:].mean() == least,
            "optimistic": is_optimistic([name], method),
        }
        for method, values in results.items()
    ]
    return {"set": name, "spectra": len(queried.rgb), "rows": rows}


def learning_curve(parts: int) -> Row:
    """Return the errors at each part of the mixture of cubes, and of regressions, that
    know the others.
    """
    mixture = materials(MIXTURE)
    left_out = shipped_families(MIXTURE)
    of_cubes = []
    of_regressions = []
    rows = np.arange(len(mixture.rgb))
    for seed in range(SPLITS):
        shuffled = np.random.default_rng(seed).permutation(rows)
        for held in np.array_split(shuffled, parts):
            known = mixture.take(np.setdiff1d(rows, held))
            cube = known.cube(dim=DIM, leave_out=left_out)
            queried = mixture.take(held)
            regression = local_linear(cube.data, known.measured, queried.rgb)
            answers = cube.reflectance(queried.rgb)
            of_cubes.append(light_errors(answers, queried))
            of_regressions.append(light_errors(regression, queried))
    row = {"known": 1 - 1 / parts}
    named = {held_out.HALF: of_cubes, held_out.LOCAL_LINEAR: of_regressions}
    for method, delta_e in named.items():
        mean = np.concatenate(delta_e).mean(axis=0)
        row[method] = {"mean": mean.mean(), "errors": by_light(mean)}
    return row


def light_errors(answers: Array, queried: Materials) -> Array:
    """Return ΔE00 (n, L) under each light."""
    return held_out.spectrum_errors(answers, queried.measured).delta_e


@cache
def methods() -> dict[str, Uplift]:
    """Return the methods of other authors, which use no atlas, by title."""
    task = make_task({"macbeth": spectra("macbeth")})
    return {
        method.title: method.prepare(task).uplift
        for method in select_methods(PUBLISHED)
    }


def published(queried: Materials) -> dict[str, Array]:
    """Return the answers (n, N) of other authors' methods."""
    return {
        title: uplift_rgb(queried.rgb, SENSOR.wavelengths)
        for title, uplift_rgb in methods().items()
    }


@cache
def smooth_cube(count: int) -> Cube:
    """Return a coarse cube of smooth spectra."""
    return build(dim=COARSE, coefficients=count, prior="smooth")


def means(answers: Cube | Array, queried: Materials) -> Array:
    """Return mean rms, then mean ΔE00 under each light."""
    if isinstance(answers, Cube):
        answers = answers.reflectance(queried.rgb)
    return held_out.spectrum_errors(answers, queried.measured).means()


def mean_delta_e(queried: Materials, *atlas: str, **options: Any) -> Array:
    """Return mean ΔE00 (L,) under each light of a coarse cube."""
    return means(build(*atlas, dim=COARSE, **options), queried)[1:]


def unseen(name: str, count: int) -> Row:
    """Return the errors without an atlas for an unknown family, and their ratios to
    those of other methods.
    """
    queried = materials(name)
    left_out = shipped_families(name)
    learnt = mean_delta_e(queried, coefficients=count, leave_out=left_out)
    others = {
        "smooth": smooth_cube(count),
        **published(queried),
        "sigmoid": build(dim=COARSE, model="sigmoid"),
    }
    ratios = {
        method: learnt / means(answers, queried)[1:]
        for method, answers in others.items()
    }
    return {
        "set": name,
        "spectra": len(queried.rgb),
        "coefficients": count,
        "learnt": by_light(learnt),
        "against_smooth": by_light(ratios["smooth"]),
        "worst": {method: ratio.max() for method, ratio in ratios.items()},
    }


def with_atlas(name: str) -> Row:
    """Return the mean error of ColorChecker cubes for a set that the prior does not
    know.
    """
    queried = materials(name)
    left_out = [*shipped_families(name), "checker"]
    smooth = mean_delta_e(queried, "macbeth", prior="smooth")
    learnt = mean_delta_e(queried, "macbeth", leave_out=left_out)
    ratios = learnt / smooth
    return {
        "set": name,
        "smooth": smooth.mean(),
        "learnt": learnt.mean(),
        "no_atlas": mean_delta_e(queried, leave_out=left_out).mean(),
        "ratio": ratios.mean(),
        "worst": ratios.max(),
    }


def with_library(name: str) -> Iterator[Row]:
    """Yield the errors at one half of a set, relative to smooth spectra, where cubes
    know the other half.
    """
    entries = spectra(name).entries
    half, _ = held_out.random_halves(len(entries), 0)
    atlas = Atlas(tuple(entries[row] for row in sorted(half)))
    known = {entry.values.tobytes() for entry in atlas}
    others = [entry for entry in entries if entry.values.tobytes() not in known]
    queried = inside(Atlas(tuple(others)))
    smooth = means(smooth_cube(9), queried)[1:]
    learnt = {"leave_out": shipped_families(name)}
    cubes = {
        "learnt": learnt,
        "learnt, the other half as library": {"library": atlas, **learnt},
        "smooth, the other half as atlas": {"atlas": atlas, "prior": "smooth"},
        "learnt, the other half as atlas": {"atlas": atlas, **learnt},
    }
    for label, options in cubes.items():
        ratio = mean_delta_e(queried, **options) / smooth
        yield {"set": name, "cube": label, "mean": ratio.mean(), "worst": ratio.max()}
