"""Whole cubes, 32³: entries at their own colours, half an atlas for the other half, errors stated, smoothness."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

import uplift
from benchmarks.fidelity.between import LIMITS
from benchmarks.fidelity.materials import (
    HEAD,
    JUDGED_ON,
    SENSOR,
    Materials,
    ahead,
    entries,
    large,
    materials,
    row,
    spectra,
    spectra_of,
)
from benchmarks.page import table
from uplift import fit
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.arrays import Array
from uplift.lab.study.held_out import HoldoutSplit, holdout, spectrum_errors
from uplift.lattice import Lattice
from uplift.lookup import Cube
from uplift.models import Moments
from uplift.report.calibration import calibration
from uplift.report.smoothness import smoothness

DIM = 32
COUNTS = (9, 13, 17)
SPLITS = 3


def sections() -> list[str]:
    found = {
        (name, count): holdout(spectra(name), SPLITS, dim=DIM, coefficients=count)
        for name in large()
        for count in COUNTS
    }
    return [_own(), _halves(found), _targets(found), _stated(found), _seeds(), _smoothness()]


def build(name: str | None, **options: object) -> Cube:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(spectra(name) if name else None, **{"dim": DIM, **options})


def _own() -> str:
    rows = []
    for name in (*JUDGED_ON, "rawtoaces"):
        some = materials(name)
        for label, cube in {
            "9 coefficients": build(name),
            "17 coefficients": build(name, coefficients=17),
            "9, without the atlas": build(None),
            "sigmoid": build(name, model="sigmoid"),
        }.items():
            rows.append([name, *row(label, cube.reflectance(some.rgb), some)])
    return table(
        "Atlas entries asked at their own colours",
        f"Cubes of {DIM}³. Entries are nodes of the lattice: what is left is what the coefficients lose.",
        ["atlas", "cube", *HEAD],
        rows,
    )


def _halves(found: dict[tuple[str, int], tuple[HoldoutSplit, ...]]) -> str:
    rows = []
    for (name, count), splits in found.items():
        for method in splits[0].errors:
            means = np.array([split.errors[method].means() for split in splits])
            cells = [
                f"{mean:.3f} ± {spread:.3f}" for mean, spread in zip(means.mean(0), means.std(0), strict=True)
            ]
            rows.append([name, str(count), method, *cells])
        if count == COUNTS[-1]:
            for label, predict in LIMITS.items():
                limit = np.mean([_limit(name, predict, seed) for seed in range(SPLITS)], axis=0)
                rows.append([name, "", f"*limit:* {label}", *(f"{value:.3f}" for value in limit)])
    return table(
        "Half of an atlas for the other half",
        f"Cubes of {DIM}³ from one half, asked at the colours of the other; {SPLITS} splits, ± their spread. "
        "*Limits* krige whole spectra, in the way of this page's prior and in that of the quadratic trend: 81 samples "
        "for every colour, which neither stay within [0, 1] nor have the colour.",
        ["atlas", "coefficients", "cube", *HEAD],
        rows,
    )


def _limit(name: str, predict: Callable[[Materials, Materials], Array], seed: int) -> Array:
    some = materials(name)
    kept, asked = np.array_split(np.random.default_rng(seed).permutation(len(some.rgb)), 2)
    return spectrum_errors(predict(some.take(kept), some.take(asked)), some.measured[asked]).means()


def _targets(found: dict[tuple[str, int], tuple[HoldoutSplit, ...]]) -> str:
    rows = []
    for (name, count), splits in found.items():
        ours, sigmoid, plain = (
            np.array([split.errors[method].means() for split in splits]).mean(axis=0)
            for method in ("half the atlas", "sigmoid", "without an atlas")
        )
        share, against = ours / sigmoid, ours / plain
        worst = HEAD[1 + int(against[1:].argmax())]
        rows.append(
            [
                name,
                str(count),
                f"{share[0]:.2f}",
                f"{share[1]:.2f}",
                f"{share[4]:.2f}",
                f"{against[1:].max():.2f} ({worst})",
            ]
        )
    return table(
        "The same in shares",
        "Of the sigmoid's rms and ΔE00; and the light that the atlas helps least under, in shares of ΔE00 without one.",
        ["atlas", "coefficients", "rms", "A", "FL11", "least helped"],
        rows,
    )


def _stated(found: dict[tuple[str, int], tuple[HoldoutSplit, ...]]) -> str:
    rows = []
    strangers = {(f"macbeth, asked for {name}", 9): (_across("macbeth", name),) for name in large()}
    for (name, count), splits in (found | strangers).items():
        real, stated = (
            np.concatenate([getattr(split, part) for split in splits]) for part in ("real", "stated")
        )
        said = calibration(real, stated)
        quarters = [
            f"{_root(real[part]):.2f} / {_root(stated[part]):.2f}"
            for part in np.array_split(stated.argsort(kind="stable"), 4)
        ]
        shares = (f"{said.within_one:.0%}", f"{said.within_two:.0%}")
        rows.append([name, str(count), f"{said.real:.2f} / {said.stated:.2f}", *shares, *quarters])
    return table(
        "Standard errors that cubes state, and real ones",
        "ΔE00 under A of the half that the cube has not seen, as roots of mean squares: real / stated; how many of the "
        "real errors lie within one and within two stated ones; and the same for the four quarters of the colours, "
        "from those that the cube is most sure of to those that it is least sure of.",
        ["atlas", "coefficients", "all", "within 1", "within 2", "surest", "second", "third", "least sure"],
        rows,
    )


def _across(known: str, asked: str) -> HoldoutSplit:
    """A cube of one atlas asked for another."""
    cube, some = build(known), materials(asked)
    answered = cube.reflectance(some.rgb)
    light = observer.light(cube.data.error_illuminant)
    return HoldoutSplit({}, delta_e_spectra(light, answered, some.measured), cube.standard_error(some.rgb))


def _root(errors: Array) -> float:
    return float(np.sqrt((errors**2).mean()))


def _seeds() -> str:
    """Cubes whose seeds start from their entries, or from the prior as all other points do."""
    rows = []
    for name in large():
        some, model = materials(name), Moments(9)
        kept, asked = np.array_split(np.random.default_rng(0).permutation(len(some.rgb)), 2)
        found = entries(model, some.take(kept))
        lattice = Lattice(observer.axis_nodes("srgb", DIM))
        problem = fit.Problem(model, ahead(model), lattice)
        prior = fit.fit_prior(problem, SENSOR, found, observer.light("A"))
        seeds = fit.seed(lattice, found.rgb)
        nobody = fit.Seeds(seeds.points[:0], seeds.entry[:0], seeds.primary[:0], ())
        for label, chosen in {"their entries, the default": seeds, "the prior": nobody}.items():
            fitted = fit.fit_lattice(problem, chosen, found.multipliers, prior)
            points = model.from_storage(fitted.coefficients)
            for asks, part in {"the other half": asked, "the half it knows": kept}.items():
                corners, weights = lattice.corners(some.rgb[part])
                around = spectra_of(model, points[corners.ravel()]).reshape(*corners.shape, -1)
                answered = (weights[..., None] * around).sum(axis=1)
                rows.append([name, label, asks, *row("", answered, some.take(part))[1:]])
    return table(
        "What seeds start from",
        f"The lattice alone, {DIM}³, 9 coefficients, entries not yet nodes of it. From the prior, the lattice says a "
        "little more about materials unknown; from their entries, seeds keep known ones in the whole voxel around "
        "their colour, where paintings have their shades.",
        ["atlas", "seeds start from", "asked", *HEAD],
        rows,
    )


def _smoothness() -> str:
    rows = []
    for name in (None, "macbeth", "rawtoaces", *large()[2:]):
        for count in (9, 17):
            steps = smoothness(build(name, coefficients=count).data).differences
            rows.append(
                [
                    name or "none",
                    str(count),
                    f"{steps.mean():.4f}",
                    f"{np.quantile(steps, 0.99):.3f}",
                    f"{steps.max():.3f}",
                ]
            )
    return table(
        "Smoothness of the lattice",
        f"rms difference between the spectra of neighbouring points along the axes, {DIM}³: mean, 99 % and largest.",
        ["atlas", "coefficients", "mean", "99 %", "largest"],
        rows,
    )
