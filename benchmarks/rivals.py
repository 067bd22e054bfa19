"""Methods that know the library, compared with a cube without an atlas, for
docs/materials.md and docs/accuracy.md.
"""

from collections.abc import Mapping
from functools import cache
from itertools import product

import numpy as np

from benchmarks import Row, record
from benchmarks.choices import ALONE, is_optimistic
from benchmarks.materials import (
    FETCHED,
    SHIPPED,
    by_light,
    materials,
    shipped_families,
)
from uplift import build
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.measures import delta_e_under
from uplift.fit import families_with
from uplift.lab.study.look_alikes import look_alikes
from uplift.lab.study.rivals import MAPS, RIVALS, library_spectra, rival_errors
from uplift.lookup import Cube
from uplift.lookup.errors_under_lights import light_errors

DIM = 32
SETS = (*SHIPPED, *FETCHED)
LARGE_SETS = ("cie2017", "rawtoaces")
CHECKERS = ("macbeth", "babelcolor")
ROOT_POLYNOMIALS = MAPS[1:]
TIE = 0.05
"""Relative difference of means that counts as a tie."""
VISIBLE = 1.0
"""ΔE00 that is just visible."""
SHARE = 0.95
"""Share of the errors within the quantile."""
LIGHTS = [observer.light(name) for name in HELD_OUT_LIGHTS]


def main() -> None:
    """Measure and store."""
    record(
        "rivals",
        dim=DIM,
        lights=list(HELD_OUT_LIGHTS),
        tie=TIE,
        visible=VISIBLE,
        share=SHARE,
        sets=map(of_set, SETS),
        pooled=pooled(),
        methods=map(verdict, RIVALS),
        behind=behind(),
        alike=map(alike, SHIPPED),
        known=map(effect_of_look_alikes, CHECKERS),
        stated=stated(),
    )


@cache
def cube_without(name: str) -> Cube:
    """A cube without an atlas that does not know the family of a set."""
    return build(dim=DIM, leave_out=shipped_families(name))


@cache
def within(name: str) -> Array:
    """Which ΔE00 (n, L, 2) of the materials of a set lie within the standard error and
    the error bound that the cube without the set states.
    """
    queried = materials(name)
    cube = cube_without(name)
    missed = errors(name)[ALONE]
    radii = [light_errors(cube.data, light)(queried.rgb) for light in LIGHTS]
    return missed[:, :, None] <= np.stack(radii, axis=1)


def stated() -> list[Row]:
    """Return the shares of materials of each set within the stated errors, and of all
    shipped sets.
    """
    inside = {name: within(name) for name in SETS}
    inside["all shipped"] = np.concatenate([within(name) for name in SHIPPED])
    rows = []
    for name, shares in inside.items():
        standard, bound = shares.mean(axis=0).T
        rows.append(
            {
                "set": name,
                "standard": shares[..., 0].mean(),
                "bound": shares[..., 1].mean(),
                "standards": by_light(standard),
                "bounds": by_light(bound),
            }
        )
    return rows


@cache
def errors(name: str) -> Mapping[str, Array]:
    """ΔE00 (n, L) of all methods at the materials of a set, whose family they do not
    know.
    """
    queried = materials(name)
    cube = cube_without(name)
    answers = cube.reflectance(queried.rgb)
    known = library_spectra(shipped_families(name))
    rivals = rival_errors(cube.data, known, queried.measured, LIGHTS)
    return {ALONE: delta_e_under(LIGHTS, answers, queried.measured), **rivals}


def summary(delta_e: Array) -> Row:
    """Return mean and 95 % of ΔE00 (n, L), over the lights and under each."""
    return {
        "mean": delta_e.mean(),
        "p95": np.quantile(delta_e, SHARE),
        "means": by_light(delta_e.mean(axis=0)),
        "p95s": by_light(np.quantile(delta_e, SHARE, axis=0)),
    }


def of_set(name: str) -> Row:
    """Return the errors of all methods at a set."""
    rows = []
    for method, delta_e in errors(name).items():
        optimistic = is_optimistic([name], method)
        rows.append({"method": method, "optimistic": optimistic, **summary(delta_e)})
    return {
        "set": name,
        "spectra": len(materials(name).rgb),
        "left_out": shipped_families(name),
        "rows": rows,
    }


def pooled() -> list[Row]:
    """Return the errors of all methods at the materials of all shipped sets."""
    rows = []
    for method in (ALONE, *RIVALS):
        delta_e = np.concatenate([errors(name)[method] for name in SHIPPED])
        optimistic = is_optimistic(SHIPPED, method)
        rows.append({"method": method, "optimistic": optimistic, **summary(delta_e)})
    return rows


def verdict(method: str) -> Row:
    """Return the sets on which a method is ahead of the cube or ties with it, and the
    lights under which its mean over the shipped sets is not visible.
    """
    ahead = []
    tied = []
    for name in SETS:
        ratio = errors(name)[method].mean() / errors(name)[ALONE].mean()
        if ratio < 1 - TIE:
            ahead.append(name)
        elif ratio <= 1 + TIE:
            tied.append(name)
    means = np.concatenate([errors(name)[method] for name in SHIPPED]).mean(axis=0)
    enough = [
        light
        for light, mean in zip(HELD_OUT_LIGHTS, means, strict=True)
        if mean <= VISIBLE
    ]
    return {"method": method, "ahead": ahead, "tied": tied, "enough": enough}


def behind() -> list[Row]:
    """Return the lights under which the cube is behind root polynomials on the large
    shipped sets, in the mean or at 95 %.
    """
    rows = []
    for name, method in product(LARGE_SETS, ROOT_POLYNOMIALS):
        cube = summary(errors(name)[ALONE])
        rival = summary(errors(name)[method])
        for key, title in (("means", "mean"), ("p95s", f"{SHARE:.0%}")):
            lights = [
                light
                for light in HELD_OUT_LIGHTS
                if rival[key][light] < cube[key][light]
            ]
            if lights:
                rows.append(
                    {"set": name, "method": method, "of": title, "lights": lights}
                )
    return rows


def alike(name: str) -> Row:
    """Return the numbers of spectra of a set with a look-alike, by family that does not
    contain the set.
    """
    measured = materials(name).measured
    own = families_with(measured)
    counts = {
        family: int(rows.sum())
        for family, rows in look_alikes(measured).items()
        if family not in own
    }
    return {"set": name, "spectra": len(measured), "counts": counts}


def effect_of_look_alikes(name: str) -> Row:
    """Return by how much the mean ΔE00 at a set rises where a cube does not know its
    look-alikes.
    """
    queried = materials(name)
    cube = build(dim=DIM, leave_out=families_with(queried.measured))
    known = delta_e_under(LIGHTS, cube.reflectance(queried.rgb), queried.measured)
    return {"set": name, "change": errors(name)[ALONE].mean() / known.mean() - 1}
