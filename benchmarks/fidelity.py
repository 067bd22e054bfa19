"""Spectra of cubes compared with measured spectra, for docs/materials.md and
docs/prior.md.
"""

from collections.abc import Iterator
from dataclasses import asdict
from functools import cache
from itertools import chain, product

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
    LARGE,
    MIXTURE,
    MUNSELL,
    SENSOR,
    SPLITS,
    Materials,
    as_record,
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
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.cube import contents
from uplift.extras.report.measures import check_calibration
from uplift.fit.families import LENGTH, NUGGET, shipped_library
from uplift.lab.chart.measure import select_methods
from uplift.lab.chart.method import make_task
from uplift.lab.study import held_out
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
    cubes = [*product(LARGE, COUNTS), *((name, 9) for name in (*SMALL, MIXTURE))]
    known = {
        (name, count): other_halves(name, dim=DIM, coefficients=count)
        for name, count in cubes
    }
    others = {
        f"macbeth, queried for {name}": [
            (
                build("macbeth", dim=DIM, leave_out=shipped_families(name)),
                materials(name),
            )
        ]
        for name in LARGE
    }
    record(
        "fidelity",
        dim=DIM,
        splits=SPLITS,
        munsell=MUNSELL.exists(),
        entries=list(chain.from_iterable(at_entries(name) for name in TESTED)),
        standard_errors=[
            *(coverage(*key, pairs) for key, pairs in known.items()),
            *(coverage(label, 9, pairs) for label, pairs in others.items()),
        ],
        light_errors=[
            {"atlas": name, "coefficients": count, "covered": covered(pairs)}
            for (name, count), pairs in known.items()
        ],
    )
    record(
        "fidelity",
        "held-out",
        lights=list(HELD_OUT_LIGHTS),
        splits=SPLITS,
        choices=[asdict(choice) for choice in CHOICES],
        sets=[compare_methods(name) for name in (*SETS, MIXTURE)],
    )
    record(
        "fidelity",
        "mixture",
        dim=DIM,
        splits=SPLITS,
        rows=[learning_curve(parts) for parts in PARTS],
    )
    sets = (*LIBRARY_SETS, *(["munsell"] if MUNSELL.exists() else []))
    size = FILE.stat().st_size
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
            "bytes": size,
        },
        library=[
            {"name": each.name, "spectra": len(each.measured)}
            for each in shipped_library()
        ],
        unseen=[unseen(name, count) for name in sets for count in (9, 17)],
        atlases=[with_atlas(name) for name in sets if name not in FAMILIES["checker"]],
        libraries=list(chain.from_iterable(with_library(name) for name in LARGE)),
    )


def at_entries(name: str) -> Iterator[Row]:
    """Yield the errors of cubes at the colours of their entries, and the size of the
    cubes' arrays.
    """
    some = materials(name)
    cubes = {
        f"9 coefficients, entries {count}": build(
            name, dim=DIM, entry_coefficients=count
        )
        for count in COUNTS
    }
    cubes |= {
        "17 coefficients": build(name, dim=DIM, coefficients=17),
        "9, without the atlas": build(dim=DIM),
        "sigmoid": build(name, dim=DIM, model="sigmoid"),
    }
    for label, cube in cubes.items():
        size = sum(array.nbytes for array in contents(cube.data)[0].values())
        yield {
            "atlas": name,
            "cube": label,
            "megabytes": size / 1e6,
            **errors(cube.reflectance(some.rgb), some),
        }


def pooled(splits: tuple[held_out.HoldoutSplit, ...], method: str) -> Array:
    """Mean rms, then mean ΔE00 under each light, over the splits; splits of one set
    differ by one entry at most.
    """
    return np.mean([split.errors[method].means() for split in splits], axis=0)


def stated(pairs: Pairs, light: Light) -> tuple[Array, Array]:
    """Return errors (3, n), actual, standard and bounds, and the shares (n, 2) that the
    latter two cover.
    """
    parts = [
        np.array(
            [
                delta_e_spectra(light, cube.reflectance(some.rgb), some.measured),
                cube.standard_error(some.rgb, light),
                cube.error_bound(some.rgb, light),
            ]
        )
        for cube, some in pairs
    ]
    found = np.concatenate(parts, axis=1)
    return found, (found[0] <= found[1:]).T


def coverage(label: str, count: int, pairs: Pairs) -> Row:
    """Return the coverage under the light of the nodes."""
    found, _ = stated(pairs, observer.light(pairs[0][0].data.error_illuminant))
    overall = check_calibration(*found)
    assert overall is not None
    return {
        "atlas": label,
        "coefficients": count,
        "all": [overall.actual, overall.predicted],
        "within_error": overall.within_error,
        "within_bound": overall.within_bound,
    }


def covered(pairs: Pairs) -> dict[str, Array]:
    """Return, by light, the shares of errors within the standard error and within the
    error bound.
    """
    return {
        name: stated(pairs, observer.light(name))[1].mean(axis=0)
        for name in HELD_OUT_LIGHTS
    }


def compare_methods(name: str) -> Row:
    """Return the errors of all methods on the held-out halves of a set, and how they
    compare.
    """
    learnt = held_out.holdout(spectra(name), SPLITS)
    smooth = held_out.holdout(spectra(name), SPLITS, prior="smooth", leave_out=())
    found = {
        OURS: pooled(learnt, held_out.HALF),
        OURS_SMOOTH: pooled(smooth, held_out.HALF),
        held_out.LOCAL_LINEAR: pooled(learnt, held_out.LOCAL_LINEAR),
        ALONE: pooled(learnt, held_out.NO_ATLAS),
        ALONE_SMOOTH: pooled(smooth, held_out.NO_ATLAS),
        held_out.SIGMOID: pooled(learnt, held_out.SIGMOID),
    }
    some = materials(name)
    for method, answers in published(some).items():
        found[method] = held_out.spectrum_errors(answers, some.measured).means()
    means = {method: float(np.mean(values[1:])) for method, values in found.items()}
    rows = [
        {
            "method": method,
            **as_record(values),
            "mean": means[method],
            "best": means[method] == min(means.values()),
            "optimistic": is_optimistic([name], method),
        }
        for method, values in found.items()
    ]
    return {"set": name, "spectra": len(some.rgb), "rows": rows}


def learning_curve(parts: int) -> Row:
    """Return the errors at each part of the mixture of cubes that know the other ones:
    what more measurements give.
    """
    some = materials(MIXTURE)
    left_out = shipped_families(MIXTURE)
    found = []
    rows = np.arange(len(some.rgb))
    for seed in range(SPLITS):
        for queried in np.array_split(
            np.random.default_rng(seed).permutation(rows), parts
        ):
            cube = some.take(np.setdiff1d(rows, queried)).cube(
                dim=DIM, leave_out=left_out
            )
            held = some.take(queried)
            found.append(
                held_out.spectrum_errors(
                    cube.reflectance(held.rgb), held.measured
                ).delta_e
            )
    by_light = np.concatenate(found).mean(axis=0)
    return {
        "known": 1 - 1 / parts,
        "mean": by_light.mean(),
        "errors": dict(zip(HELD_OUT_LIGHTS, by_light.tolist(), strict=True)),
    }


@cache
def methods() -> Row:
    """Return the methods of other authors, which use no atlas."""
    task = make_task({"macbeth": spectra("macbeth")})
    return {
        method.title: method.prepare(task).uplift
        for method in select_methods(PUBLISHED)
    }


def published(some: Materials) -> dict[str, Array]:
    """Return the answers (n, N) of other authors' methods."""
    return {
        method: uplift_rgb(some.rgb, SENSOR.wavelengths)
        for method, uplift_rgb in methods().items()
    }


def family(name: str) -> list[str]:
    """Return the family of the shipped library that a set belongs to, if any."""
    return [key for key, names in FAMILIES.items() if name in names]


@cache
def smooth_cube(count: int) -> Cube:
    """Return a coarse cube of smooth spectra."""
    return build(dim=COARSE, coefficients=count, prior="smooth")


def means(answers: Cube | Array, some: Materials) -> Array:
    """Mean ΔE00 (L,) under each light."""
    spectra = answers.reflectance(some.rgb) if isinstance(answers, Cube) else answers
    return held_out.spectrum_errors(spectra, some.measured).means()[1:]


def unseen(name: str, count: int) -> Row:
    """Return the errors without an atlas where the prior does not know the family,
    relative to other methods.
    """
    some = materials(name)
    learnt = means(build(dim=COARSE, coefficients=count, leave_out=family(name)), some)
    others = {
        "smooth": smooth_cube(count),
        **published(some),
        "sigmoid": build(dim=COARSE, model="sigmoid"),
    }
    ratios = {
        method: learnt / means(answers, some) for method, answers in others.items()
    }
    return {
        "set": name,
        "spectra": len(some.rgb),
        "coefficients": count,
        "learnt": dict(zip(HELD_OUT_LIGHTS, learnt, strict=True)),
        "against_smooth": dict(zip(HELD_OUT_LIGHTS, ratios["smooth"], strict=True)),
        "worst": {method: ratio.max() for method, ratio in ratios.items()},
    }


def with_atlas(name: str) -> Row:
    """Return the mean error over the lights of ColorChecker cubes, queried for a set
    that the prior does not know.
    """
    some = materials(name)
    left_out = [*family(name), "checker"]
    found = {
        "smooth": means(build("macbeth", dim=COARSE, prior="smooth"), some),
        "learnt": means(build("macbeth", dim=COARSE, leave_out=left_out), some),
        "no_atlas": means(build(dim=COARSE, leave_out=left_out), some),
    }
    ratios = found["learnt"] / found["smooth"]
    mean_errors = {key: each.mean() for key, each in found.items()}
    return {"set": name, **mean_errors, "ratio": ratios.mean(), "worst": ratios.max()}


def with_library(name: str) -> Iterator[Row]:
    """Yield the errors at one half of a set, relative to smooth spectra, with the other
    half as a library.
    """
    entries = spectra(name).entries
    atlas = Atlas(
        tuple(
            entries[row] for row in sorted(held_out.random_halves(len(entries), 0)[0])
        )
    )
    known = {entry.values.tobytes() for entry in atlas}
    others = Atlas(
        tuple(entry for entry in entries if entry.values.tobytes() not in known)
    )
    queried = inside(others)
    smooth = means(smooth_cube(9), queried)
    for label, options in {
        "learnt": {"leave_out": family(name)},
        "learnt, the other half as library": {
            "library": atlas,
            "leave_out": family(name),
        },
        "smooth, the other half as atlas": {"atlas": atlas, "prior": "smooth"},
        "learnt, the other half as atlas": {"atlas": atlas, "leave_out": family(name)},
    }.items():
        ratio = means(build(dim=COARSE, **options), queried) / smooth
        yield {"set": name, "cube": label, "mean": ratio.mean(), "worst": ratio.max()}
