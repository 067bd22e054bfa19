"""What an atlas does to materials unlike it, for docs/prior.md."""

from collections.abc import Iterator
from functools import cache
from itertools import permutations

from benchmarks import Row
from benchmarks.materials import FETCHED, MIXTURE, materials, split_tasks, task
from uplift.common.arrays import Array
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import measure, named_lights, pooled_errors

DIM = 32
LIGHTS = ("A", "FL2", "FL11", "LED-B3", "LED-RGB1", "HP1")
ATLASES = ("macbeth", "pmc", "cie2017", "rawtoaces", *FETCHED)
SETS = (*ATLASES, MIXTURE)
ALONE = cube(dim=DIM)
TRUSTING = {
    "learnt trust": cube(atlas=True, dim=DIM),
    "full trust": cube(atlas=True, dim=DIM, trust_atlas=True),
}


def own() -> Iterator[Row]:
    """Yield the errors at unseen halves of sets whose other halves are the atlas."""
    methods = {"without an atlas": ALONE, **TRUSTING}
    for name in SETS:
        yield from measure(methods, split_tasks(name), named_lights(LIGHTS), set=name)


@cache
def errors_alone(name: str) -> Array:
    """Return the mean ΔE00 (L,) at a set of a cube without an atlas."""
    lights = list(named_lights(LIGHTS).values())
    return pooled_errors(ALONE, [task(name)], lights).delta_e.mean(axis=0)


def others() -> Iterator[Row]:
    """Yield how many times the errors of a cube without an atlas those of one with
    another set as atlas are: the mean over lights, and the worst light.
    """
    lights = list(named_lights(LIGHTS).values())
    for atlas, queried in permutations(ATLASES, 2):
        alone = errors_alone(queried)
        query = task(queried, materials(atlas).atlas)
        for trust, method in TRUSTING.items():
            errors = pooled_errors(method, [query], lights).delta_e.mean(axis=0)
            row = {"atlas": atlas, "queried": queried, "trust": trust}
            ratios = errors / alone
            yield row | {"mean": errors.mean() / alone.mean(), "worst": ratios.max()}


QUESTIONS = {"own": own, "others": others}
