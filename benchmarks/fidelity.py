"""Spectra of cubes compared with measured spectra, for docs/fidelity.md and docs/prior.md."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator
from dataclasses import asdict
from functools import cache
from typing import Any

import numpy as np

import uplift
from benchmarks import record
from benchmarks.choices import ALONE, ALONE_SMOOTH, CHOICES, OURS, OURS_SMOOTH, is_optimistic
from benchmarks.materials import (
    LARGE,
    MUNSELL,
    SENSOR,
    SPLITS,
    Materials,
    as_record,
    build,
    errors,
    materials,
    other_halves,
    shipped_families,
    spectra,
)
from tools.ship_library import FAMILIES, FILE, OTSU_SPREAD, SPREAD
from uplift.atlas import Atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Mask
from uplift.cube import contents
from uplift.fit.families import LENGTH, NUGGET, shipped_library
from uplift.lab.chart.measure import select_methods
from uplift.lab.chart.method import make_task
from uplift.lab.study.held_out import (
    CENTROID,
    HALF,
    LOCAL_LINEAR,
    NEIGHBOURS,
    NO_ATLAS,
    SIGMOID,
    HoldoutSplit,
    holdout,
    mismatch_centroids,
)
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.report.measures import check_calibration, compute_smoothness

DIM, COARSE = 32, 16
COUNTS = (9, 13, 17)
SETS = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017")
"""Sets of at least 20 entries. The others are too small to split."""
TESTED = ("macbeth", "cie2017", "rawtoaces")
KNOWN = ("macbeth", "cie2017")
"""Atlases of the cubes that are queried for other sets."""
MIN_COLOURS = 10
"""Fewer colours are not listed."""
LIBRARY_SETS = tuple(name for names in FAMILIES.values() for name in names)
PUBLISHED = ("otsu2018", "mallett2019", "smits1999")
RUNS = 2
Row = dict[str, Any]


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    splits = {
        (name, count): holdout(spectra(name), SPLITS, dim=DIM, coefficients=count, leave_out=shipped_families(name))
        for name in LARGE
        for count in COUNTS
    }
    record(
        "fidelity",
        dim=DIM,
        splits=SPLITS,
        munsell=MUNSELL.exists(),
        entries=[row for name in TESTED for row in at_entries(name)],
        halves=[row for key, found in splits.items() for row in halves(*key, found)],
        shares=[shares(*key, found) for key, found in splits.items()],
        smoothness=[
            neighbour_steps(name, count) for name in (None, "macbeth", "rawtoaces", *LARGE[2:]) for count in (9, 17)
        ],
        **coverage(),
    )
    record(
        "fidelity",
        "held-out",
        lights=list(HELD_OUT_LIGHTS),
        splits=SPLITS,
        neighbours=NEIGHBOURS,
        choices=[asdict(choice) for choice in CHOICES],
        sets=[compare_methods(name) for name in SETS],
    )
    sets = (*LIBRARY_SETS, *(["munsell"] if MUNSELL.exists() else []))
    record(
        "fidelity",
        "prior",
        dim=COARSE,
        build_dim=DIM,
        lights=list(HELD_OUT_LIGHTS),
        parameters={
            "length": LENGTH,
            "nugget": NUGGET,
            "spread": SPREAD,
            "otsu_spread": OTSU_SPREAD,
            "bytes": FILE.stat().st_size,
        },
        library=[{"name": each.name, "spectra": len(each.measured)} for each in shipped_library()],
        unseen=[unseen(name, count) for name in sets for count in (9, 17)],
        atlases=[with_atlas(name) for name in sets if name not in FAMILIES["checker"]],
        relevance=[relevance(name) for name in ("macbeth", "rawtoaces", "cie2017")],
        libraries=[row for name in LARGE for row in with_library(name)],
        smoothness=list(coarse_smoothness()),
        builds=[build_time(space) for space in ("sRGB", "ACEScg")],
    )


def at_entries(name: str) -> Iterator[Row]:
    """Yield the errors of cubes at the colours of their entries, and the size of the cubes' arrays."""
    some = materials(name)
    cubes = {f"9 coefficients, entries {count}": build(name, dim=DIM, entry_coefficients=count) for count in COUNTS}
    cubes |= {
        "17 coefficients": build(name, dim=DIM, coefficients=17),
        "9, without the atlas": build(None, dim=DIM),
        "sigmoid": build(name, dim=DIM, model="sigmoid"),
    }
    for label, cube in cubes.items():
        size = sum(array.nbytes for array in contents(cube.data)[0].values())
        yield {"atlas": name, "cube": label, "megabytes": size / 1e6, **errors(cube.reflectance(some.rgb), some)}


def halves(name: str, count: int, splits: tuple[HoldoutSplit, ...]) -> Iterator[Row]:
    """Yield the errors of every cube at the held-out half, with their standard deviation over the splits."""
    for method in (HALF, NO_ATLAS, SIGMOID):
        means = np.array([split.errors[method].means() for split in splits])
        mean, std = as_record(means.mean(axis=0)), as_record(means.std(axis=0))
        both = {key: {"mean": mean["errors"][key], "std": std["errors"][key]} for key in mean["errors"]}
        rms = {"mean": mean["rms"], "std": std["rms"]}
        yield {"atlas": name, "coefficients": count, "cube": method, "rms": rms, "errors": both}


def shares(name: str, count: int, splits: tuple[HoldoutSplit, ...]) -> Row:
    """Return the errors relative to the sigmoid, and the light under which the atlas helps least."""
    ours, sigmoid, plain = (pooled(splits, method) for method in (HALF, SIGMOID, NO_ATLAS))
    share, against = as_record(ours / sigmoid), as_record(ours / plain)["errors"]
    worst = max(against, key=against.__getitem__)
    return {
        "atlas": name,
        "coefficients": count,
        "rms": share["rms"],
        "A": share["errors"]["A"],
        "FL11": share["errors"]["FL11"],
        "worst": {"ratio": against[worst], "light": worst},
    }


def pooled(splits: tuple[HoldoutSplit, ...], method: str) -> Array:
    """Mean rms, then mean ΔE00 under each light, over the splits; splits of one set differ by one entry at most."""
    return np.mean([split.errors[method].means() for split in splits], axis=0)


def neighbour_steps(name: str | None, count: int) -> Row:
    """Return the rms difference between the spectra of neighbouring nodes."""
    steps = compute_smoothness(build(name, dim=DIM, coefficients=count).data).differences
    quantiles = {"mean": steps.mean(), "p99": np.quantile(steps, 0.99), "max": steps.max()}
    return {"atlas": name or "none", "coefficients": count, **quantiles}


def coverage() -> Row:
    """Return how many errors the standard errors cover: of the other halves of sets, and of other sets."""
    known = {(name, count): other_halves(name, dim=DIM, coefficients=count) for name in LARGE for count in (9, 17)}
    others = {
        (atlas, name): [(build(atlas, dim=DIM, leave_out=shipped_families(name)), materials(name))]
        for atlas in KNOWN
        for name in LARGE
        if name != atlas
    }
    own_light = [quartiles(name, count, pairs) for (name, count), pairs in known.items()]
    own_light += [
        quartiles(f"{atlas}, queried for {name}", 9, pairs)
        for (atlas, name), pairs in others.items()
        if atlas == KNOWN[0]
    ]
    return {
        "light_splits": SPLITS,
        "standard_errors": own_light,
        "light_errors": [
            {"atlas": name, "coefficients": count, "covered": covered(pairs)} for (name, count), pairs in known.items()
        ],
        "other_families": [row for key, pairs in others.items() for row in across(*key, pairs)],
    }


def quartiles(label: str, count: int, pairs: list[tuple[Cube, Materials]]) -> Row:
    """Return the coverage under the light of the nodes, overall and by quartile of the standard error."""
    light = observer.light(pairs[0][0].data.error_illuminant)
    parts = [_errors(cube, some, light) for cube, some in pairs]
    actual, predicted, bound = (np.concatenate(part) for part in zip(*parts, strict=True))
    found = check_calibration(actual, predicted, bound)
    assert found is not None
    within = np.stack([actual <= predicted, actual <= bound], axis=1)
    by_size = np.array_split(predicted.argsort(kind="stable"), 4)
    return {
        "atlas": label,
        "coefficients": count,
        "all": [found.actual, found.predicted],
        "within_error": found.within_error,
        "within_bound": found.within_bound,
        "quartiles": [within[rows].mean(axis=0).tolist() for rows in by_size],
    }


def across(atlas: str, name: str, pairs: list[tuple[Cube, Materials]]) -> Iterator[Row]:
    """Yield the coverage of another set, of colours that are like the atlas and of those that are not."""
    ((cube, some),) = pairs
    unlike = cube.unlike_atlas(some.rgb)
    for label, rows in {"like the atlas": ~unlike, "unlike the atlas": unlike}.items():
        if rows.sum() >= MIN_COLOURS:
            share, found = float(rows.mean()), covered(pairs, rows)
            yield {"atlas": atlas, "queried": name, "colours": label, "share": share, "covered": found}


def covered(pairs: list[tuple[Cube, Materials]], rows: Mask | None = None) -> dict[str, list[float]]:
    """Return, by light, the shares of errors within the standard error and within the error bound."""
    found = {}
    for name in HELD_OUT_LIGHTS:
        parts = [_errors(cube, some, observer.light(name)) for cube, some in pairs]
        actual, predicted, bound = (np.concatenate(part) for part in zip(*parts, strict=True))
        within = np.stack([actual <= predicted, actual <= bound], axis=1)
        found[name] = within[slice(None) if rows is None else rows].mean(axis=0).tolist()
    return found


def _errors(cube: Cube, some: Materials, light: Light) -> tuple[Array, Array, Array]:
    """Return actual errors (n,), standard errors and error bounds."""
    actual = delta_e_spectra(light, cube.reflectance(some.rgb), some.measured)
    predicted, bound = cube.standard_error(some.rgb, light), cube.error_bound(some.rgb, light)
    assert predicted is not None
    assert bound is not None
    return actual, predicted, bound


def compare_methods(name: str) -> Row:
    """Return the errors of all methods on the held-out halves of a set, and how they compare."""
    learnt = holdout(spectra(name), SPLITS)
    smooth = holdout(spectra(name), SPLITS, prior="smooth", leave_out=())
    found = {
        OURS: pooled(learnt, HALF),
        OURS_SMOOTH: pooled(smooth, HALF),
        LOCAL_LINEAR: pooled(learnt, LOCAL_LINEAR),
        CENTROID: pooled(learnt, CENTROID),
        ALONE: pooled(learnt, NO_ATLAS),
        ALONE_SMOOTH: pooled(smooth, NO_ATLAS),
        SIGMOID: pooled(learnt, SIGMOID),
    }
    some = materials(name)
    for method, uplift_rgb in published().items():
        answer = errors(uplift_rgb(some.rgb, SENSOR.wavelengths), some)
        found[method] = np.array([answer["rms"], *answer["errors"].values()])
    means = {method: float(np.mean(values[1:])) for method, values in found.items()}
    best = min(means, key=lambda method: means[method])
    kept, held_out = np.array_split(np.random.default_rng(0).permutation(len(some.rgb)), 2)
    centroids = mismatch_centroids(SENSOR, some.measured[kept], some.rgb[held_out], [SENSOR.light])
    return {
        "set": name,
        "spectra": len(some.rgb),
        "without_metamer": float(np.isnan(centroids[:, 0, 0]).mean()),
        "rows": [
            {
                "method": method,
                "rms": None if np.isnan(values[0]) else values[0],
                "mean": means[method],
                "errors": dict(zip(HELD_OUT_LIGHTS, values[1:].tolist(), strict=True)),
                "best": method == best,
                "optimistic": is_optimistic([name], method),
            }
            for method, values in found.items()
        ],
    }


@cache
def published() -> dict[str, Any]:
    """Return the methods of other authors, which use no atlas."""
    task = make_task({"macbeth": spectra("macbeth")})
    return {method.title: method.prepare(task).uplift for method in select_methods(PUBLISHED)}


def family(name: str) -> list[str]:
    """Return the family of the shipped library that a set belongs to, if any."""
    return [key for key, names in FAMILIES.items() if name in names]


@cache
def smooth_cube(count: int) -> Cube:
    """Return a coarse cube of smooth spectra."""
    return build(None, dim=COARSE, coefficients=count, prior="smooth")


def means(answers: Array, some: Materials) -> Array:
    """Mean ΔE00 (L,) under each light."""
    return np.array(list(errors(answers, some)["errors"].values()))


def unseen(name: str, count: int) -> Row:
    """Return the errors without an atlas where the prior does not know the family, relative to other methods."""
    some = materials(name)
    learnt = means(build(None, dim=COARSE, coefficients=count, leave_out=family(name)).reflectance(some.rgb), some)
    smooth = means(smooth_cube(count).reflectance(some.rgb), some)
    others = {method: uplift_rgb(some.rgb, SENSOR.wavelengths) for method, uplift_rgb in published().items()}
    others["sigmoid"] = build(None, dim=COARSE, model="sigmoid").reflectance(some.rgb)
    worst = {method: float((learnt / means(answers, some)).max()) for method, answers in others.items()}
    return {
        "set": name,
        "spectra": len(some.rgb),
        "coefficients": count,
        "learnt": dict(zip(HELD_OUT_LIGHTS, learnt.tolist(), strict=True)),
        "against_smooth": dict(zip(HELD_OUT_LIGHTS, (learnt / smooth).tolist(), strict=True)),
        "worst": {"smooth": float((learnt / smooth).max()), **worst},
    }


def with_atlas(name: str) -> Row:
    """Return the mean error over the lights of ColorChecker cubes, queried for a set that the prior does not know."""
    some, left_out = materials(name), [*family(name), "checker"]
    cubes = {
        "smooth": build("macbeth", dim=COARSE, prior="smooth"),
        "learnt": build("macbeth", dim=COARSE, leave_out=left_out),
        "no_atlas": build(None, dim=COARSE, leave_out=left_out),
    }
    found = {key: means(cube.reflectance(some.rgb), some) for key, cube in cubes.items()}
    ratios = found["learnt"] / found["smooth"]
    mean_errors = {key: float(each.mean()) for key, each in found.items()}
    return {"set": name, **mean_errors, "ratio": float(ratios.mean()), "worst": float(ratios.max())}


def relevance(name: str) -> Row:
    """Return the relevance of the families as learnt from an atlas."""
    families = build(name, dim=8, leave_out=family(name)).data.provenance["families"]
    return {"atlas": name, "relevance": {each["name"]: each["relevance"] for each in families}}


def with_library(name: str) -> Iterator[Row]:
    """Yield the errors at one half of a set, relative to smooth spectra, with the other half as a library."""
    rows = np.random.default_rng(0).permutation(len(spectra(name)))
    atlas = Atlas(tuple(spectra(name)[int(row)] for row in sorted(np.array_split(rows, 2)[0])))
    known = {entry.values.tobytes() for entry in atlas}
    others = Atlas(tuple(entry for entry in spectra(name) if entry.values.tobytes() not in known))
    measured = resample(others, SENSOR.wavelengths).values
    rgb = SENSOR.rgb(measured)
    inside = SENSOR.contains(rgb)
    queried = Materials(name, measured[inside], np.clip(rgb[inside], 0, 1))
    smooth = means(smooth_cube(9).reflectance(queried.rgb), queried)
    for label, options in {
        "learnt": {"leave_out": family(name)},
        "learnt, the other half as library": {"library": atlas, "leave_out": family(name)},
        "smooth, the other half as atlas": {"atlas": atlas, "prior": "smooth"},
        "learnt, the other half as atlas": {"atlas": atlas, "leave_out": family(name)},
    }.items():
        ratio = means(uplift.build(dim=COARSE, **options).reflectance(queried.rgb), queried) / smooth
        yield {"set": name, "cube": label, "mean": float(ratio.mean()), "worst": float(ratio.max())}


def coarse_smoothness() -> Iterator[Row]:
    """Yield the rms differences between neighbours of cubes, and of spectra by Otsu et al. at the same colours."""
    found = {}
    for count in (9, 17):
        for label, cube in {
            "smooth": smooth_cube(count),
            "learnt": build(None, dim=COARSE, coefficients=count),
        }.items():
            found[f"{label}, {count} coefficients"] = compute_smoothness(cube.data).differences
    points = smooth_cube(9).data.lattice.points
    answers = published()["Otsu 2018"](points, SENSOR.wavelengths).reshape(COARSE, COARSE, COARSE, -1)
    steps = [np.sqrt((np.diff(answers, axis=axis) ** 2).mean(axis=-1)).ravel() for axis in range(3)]
    found["Otsu 2018 at the same colours"] = np.concatenate(steps)
    for label, differences in found.items():
        high = np.percentile(differences, 99)
        yield {"cube": label, "mean": differences.mean(), "high": high, "max": differences.max()}


def build_time(space: str) -> Row:
    """Return the CPU seconds of builds with both priors in turn, and their unfitted nodes."""
    seconds: dict[str, list[float]] = {"smooth": [], "learnt": []}
    unfitted = {}
    for run in range(RUNS + 1):
        for prior, times in seconds.items():
            begin = time.process_time()
            cube = build(None, dim=DIM, space=space, illuminant="D65", prior=prior)
            if run:  # the first one compiles
                times.append(time.process_time() - begin)
            unfitted[prior] = int((cube.data.points.status == Status.UNFITTED).sum())
    medians = {prior: float(np.median(times)) for prior, times in seconds.items()}
    return {"space": space, "illuminant": "D65", **medians, "unfitted": list(unfitted.values())}


if __name__ == "__main__":
    main()
