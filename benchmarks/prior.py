"""The learnt prior on materials that it does not know: ``make prior`` writes docs/data/prior.json."""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

import uplift
from benchmarks.fidelity.materials import MUNSELL, SENSOR, Materials, errors, materials, spectra
from benchmarks.fidelity.start import AT_760, DARK
from benchmarks.record import write
from tools.ship_library import FAMILIES, FILE, OTSU_SPREAD, SPREAD
from uplift.atlas import Atlas, Entry, resample
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.fit.families import LENGTH, NUGGET, shipped_library
from uplift.lab.chart.methods import mallett2019, otsu2018, smits1999
from uplift.lab.chart.task import make_task
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.report.measures import compute_smoothness

DIM = 16
COUNTS = (9, 17)
MIXED = ("rawtoaces", "cie2017")
OTHERS = {
    "Otsu 2018": otsu2018.prepare,
    "Mallett 2019": mallett2019.prepare,
    "Smits 1999": smits1999.prepare,
}
BUILD_DIM = 32
SPACES = (("sRGB", "D65"), ("ACEScg", "D65"))
RUNS = 2


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    write(
        "prior",
        "make prior",
        dim=DIM,
        build_dim=BUILD_DIM,
        lights=list(HELD_OUT_LIGHTS),
        parameters={
            "length": LENGTH,
            "nugget": NUGGET,
            "spread": SPREAD,
            "otsu_spread": OTSU_SPREAD,
            "bytes": FILE.stat().st_size,
        },
        library=[{"name": each.name, "spectra": len(each.measured)} for each in shipped_library()],
        unseen=[row for name in sets() for row in unseen(name)],
        atlases=[row for name in sets() if name not in FAMILIES["checker"] for row in with_atlas(name)],
        relevance=[relevance(name) for name in ("macbeth", *MIXED)],
        libraries=[row for name in sets() if name in (*MIXED, "munsell") for row in halves(name)],
        smoothness=list(smoothness()),
        dark=dark(),
        builds=[build_time(*each) for each in SPACES],
    )


def sets() -> tuple[str, ...]:
    """Return the names of the sets of spectra."""
    shipped = [name for names in FAMILIES.values() for name in names]
    return (*shipped, *(["munsell"] if MUNSELL.exists() else []))


def family(name: str) -> list[str]:
    """Return the family of the shipped library that a set belongs to, if any."""
    return [key for key, names in FAMILIES.items() if name in names]


@cache
def smooth_cube(coefficients: int) -> Cube:
    return uplift.build(dim=DIM, coefficients=coefficients, prior="smooth")


@cache
def sigmoid_cube() -> Cube:
    return uplift.build(dim=DIM, model="sigmoid")


@cache
def others() -> dict[str, Any]:
    """Return the methods of other authors, ready for use."""
    task = make_task({"macbeth": spectra("macbeth")})
    return {name: prepare(task).uplift for name, prepare in OTHERS.items()}


@cache
def errors_of_others(name: str) -> dict[str, Array]:
    some = materials(name)
    answers = {key: method(some.rgb, SENSOR.wavelengths) for key, method in others().items()}
    answers["sigmoid"] = sigmoid_cube().reflectance(some.rgb)
    return {key: means(spectra, some) for key, spectra in answers.items()}


def means(answers: Array, some: Materials) -> Array:
    """Mean ΔE00 (L,) under each light."""
    return np.array(list(errors(answers, some)["errors"].values()))


def unseen(name: str) -> Iterator[dict[str, Any]]:
    """Yield the errors without an atlas where the prior does not know the family, relative to other methods."""
    some = materials(name)
    for count in COUNTS:
        cube = uplift.build(dim=DIM, coefficients=count, leave_out=family(name))
        learnt = means(cube.reflectance(some.rgb), some)
        smooth = means(smooth_cube(count).reflectance(some.rgb), some)
        yield {
            "set": name,
            "spectra": len(some.rgb),
            "coefficients": count,
            "learnt": dict(zip(HELD_OUT_LIGHTS, learnt.tolist(), strict=True)),
            "against_smooth": dict(zip(HELD_OUT_LIGHTS, (learnt / smooth).tolist(), strict=True)),
            "worst": {
                "smooth": float((learnt / smooth).max()),
                **{key: float((learnt / other).max()) for key, other in errors_of_others(name).items()},
            },
        }


def with_atlas(name: str) -> Iterator[dict[str, Any]]:
    """Yield the mean error over the lights of ColorChecker cubes, queried for a set that the prior does not know."""
    some = materials(name)
    left_out = [*family(name), "checker"]
    cubes = {
        "smooth": uplift.build(spectra("macbeth"), dim=DIM, prior="smooth"),
        "learnt": uplift.build(spectra("macbeth"), dim=DIM, leave_out=left_out),
        "no_atlas": uplift.build(dim=DIM, leave_out=left_out),
    }
    found = {key: means(cube.reflectance(some.rgb), some) for key, cube in cubes.items()}
    yield {
        "set": name,
        **{key: float(each.mean()) for key, each in found.items()},
        "ratio": float((found["learnt"] / found["smooth"]).mean()),
        "worst": float((found["learnt"] / found["smooth"]).max()),
    }


def relevance(name: str) -> dict[str, Any]:
    """Return the relevance of the families as learnt from an atlas."""
    cube = uplift.build(spectra(name), dim=8, leave_out=family(name))
    families = cube.data.provenance["families"]
    return {"atlas": name, "relevance": {each["name"]: each["relevance"] for each in families}}


def halves(name: str) -> Iterator[dict[str, Any]]:
    """Yield the errors at one half of a set, relative to smooth spectra, with the other half as a library."""
    rows = np.random.default_rng(0).permutation(len(spectra(name)))
    known = np.array_split(rows, 2)[0]
    atlas = Atlas(tuple(spectra(name)[int(row)] for row in sorted(known)))
    kept = {entry.values.tobytes() for entry in atlas}
    measured = [entry for entry in spectra(name) if entry.values.tobytes() not in kept]
    queried = Materials(name, *_unknown(measured))
    smooth = means(smooth_cube(9).reflectance(queried.rgb), queried)
    for label, options in {
        "learnt": {},
        "learnt, the other half as library": {"library": atlas},
        "smooth, the other half as atlas": {"atlas": atlas, "prior": "smooth"},
        "learnt, the other half as atlas": {"atlas": atlas},
    }.items():
        cube = uplift.build(dim=DIM, **options, **({} if "prior" in options else {"leave_out": family(name)}))
        ratio = means(cube.reflectance(queried.rgb), queried) / smooth
        yield {"set": name, "cube": label, "mean": float(ratio.mean()), "worst": float(ratio.max())}


def _unknown(entries: list[Entry]) -> tuple[Array, Array]:
    """Reflectances (n, 81) and linear sRGB (n, 3) of the entries within sRGB."""
    measured = resample(Atlas(tuple(entries)), SENSOR.wavelengths).values
    rgb = SENSOR.rgb(measured)
    inside = SENSOR.contains(rgb)
    return measured[inside], np.clip(rgb[inside], 0, 1)


def smoothness() -> Iterator[dict[str, Any]]:
    """Yield the rms differences between neighbours of cubes, and of spectra by Otsu et al. at the same colours."""
    for count in COUNTS:
        for label, cube in {
            "smooth": smooth_cube(count),
            "learnt": uplift.build(dim=DIM, coefficients=count),
        }.items():
            yield {
                "cube": f"{label}, {count} coefficients",
                **_steps(compute_smoothness(cube.data).differences),
            }
    lattice = smooth_cube(9).data.lattice
    answers = others()["Otsu 2018"](lattice.points, SENSOR.wavelengths).reshape(DIM, DIM, DIM, -1)
    steps = [np.sqrt((np.diff(answers, axis=axis) ** 2).mean(axis=-1)).ravel() for axis in range(3)]
    yield {"cube": "Otsu 2018 at the same colours", **_steps(np.concatenate(steps))}


def _steps(differences: Array) -> dict[str, float]:
    return {
        "mean": float(differences.mean()),
        "high": float(np.percentile(differences, 99)),
        "max": float(differences.max()),
    }


def dark() -> dict[str, float]:
    """Return the largest reflectance at 760 nm of dark saturated colours."""
    cubes = {"smooth": smooth_cube(9), "learnt": uplift.build(dim=DIM)}
    return {label: float(cube.reflectance(DARK)[:, AT_760].max()) for label, cube in cubes.items()}


def build_time(space: str, illuminant: str) -> dict[str, Any]:
    """Return the CPU seconds of builds with both priors in turn, and their unfitted nodes."""
    seconds: dict[str, list[float]] = {"smooth": [], "learnt": []}
    unfitted = {}
    for run in range(RUNS + 1):
        for prior, times in seconds.items():
            begin = time.process_time()
            cube = uplift.build(dim=BUILD_DIM, space=space, illuminant=illuminant, prior=prior)
            if run:  # the first one compiles
                times.append(time.process_time() - begin)
            unfitted[prior] = int((cube.data.points.status == Status.UNFITTED).sum())
    smooth, learnt = (float(np.median(times)) for times in seconds.values())
    return {
        "space": space,
        "illuminant": illuminant,
        "smooth": smooth,
        "learnt": learnt,
        "unfitted": [unfitted["smooth"], unfitted["learnt"]],
    }


if __name__ == "__main__":
    main()
