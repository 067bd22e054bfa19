"""CPU time of the stages of commands, imports and tracing included, for
docs/speed.md.
"""

import functools
import importlib
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from typing import Any

from benchmarks import MACBETH, record
from uplift.extras.images.processes import call_in_child
from uplift.lab.timing import timing_stats
from uplift.samples import sample_path

RUNS = 3
LIMIT = 600
"""Seconds after which a command counts as hung."""
SAMPLE = "wood.png"
LARGE = "128"
"""Nodes along an axis of the build that runs once."""
BUILD = {
    "uplift.pipeline.entries:fit_constraints": "entries",
    "uplift.pipeline.stages:learn_base": "learnt base",
    "uplift.pipeline.stages:fit_prior": "kriging of the entries",
    "uplift.fit.seeds:initial_guess": "prior of the nodes",
    "uplift.fit.growth:Growth.attempt": "steps of the solver",
    "uplift.pipeline.stages:store": "storing",
    "uplift.fit.prior:Prior.standard_error": "standard errors",
    "uplift.lookup.cube:Cube.save": "file",
}
RELIGHT = {
    "uplift.lookup:load": "packaged cube",
    "uplift_cli.commands.relight:_cube_of_user": "cube of the atlas",
    "uplift_cli.commands.relight:read_pictures": "reading of the image",
    "uplift.extras.relight.relight:relight": "spectra and colours",
    "uplift.extras.relight.relight:relit_page": "page",
    "uplift.extras.relight.relighter:prepare_relighter": "tables of the lights",
    "uplift.extras.texture:convert": "rows of pixels",
}
TEXTURE = {
    "uplift.extras.texture.sequence:load": "packaged cube",
    "uplift.extras.texture.sequence:converter_for": "encoding",
    "uplift.extras.texture:convert": "rows of pixels",
}
"""Functions by the stage that they are; what one of them calls is counted there alone.
"""
Function = Callable[..., Any]


def main() -> None:
    """Run the commands, after a build that compiles, and store."""
    with tempfile.TemporaryDirectory() as folder:
        build = ["build", "--atlas", str(MACBETH), "-q", "--dim"]
        texture = ["texture", str(sample_path(SAMPLE))]
        commands = (
            ("build --dim 32", [*build, "32"], "x.uplift", BUILD),
            ("build --dim 64", [*build, "64"], "x.uplift", BUILD),
            ("build --dim 128", [*build, LARGE], "x.uplift", BUILD),
            ("relight -o page.html", ["relight"], "page.html", RELIGHT),
            ("relight -o lit.exr", ["relight"], "lit.exr", RELIGHT),
            (f"texture {SAMPLE}", texture, "texture.exr", TEXTURE),
        )
        rows = []
        compiling = [*build, "8", "-o", f"{folder}/x.uplift"]
        call_in_child(run, compiling, BUILD, seconds=LIMIT)
        for command, words, file, stages in commands:
            arguments = [*words, "-o", f"{folder}/{file}", "--force"]
            runs = [
                call_in_child(run, arguments, stages, seconds=LIMIT)
                for _ in range(RUNS if LARGE not in arguments else 1)
            ]
            for stage in runs[0]:
                times = timing_stats([seconds.get(stage, 0) for seconds in runs])
                rows.append({"command": command, "stage": stage, "cpu_s": times})
    record("stages", runs=RUNS, rows=rows)


def run(arguments: list[str], stages: dict[str, str]) -> dict[str, float]:
    """Run a command in this process; return the CPU seconds of its stages."""
    from uplift_cli.startup import enable_jit_cache, prepare_process

    prepare_process()
    enable_jit_cache()
    from uplift_cli.main import main as command_line

    times: Counter[str] = Counter()
    inner = [0.0]

    def clocked(function: Function, stage: str) -> Function:
        @functools.wraps(function)
        def call(*given: Any, **options: Any) -> Any:
            begin = time.process_time()
            inner.append(0.0)
            try:
                return function(*given, **options)
            finally:
                spent = time.process_time() - begin
                times[stage] += spent - inner.pop()
                inner[-1] += spent

        return call

    importlib.import_module(f"uplift_cli.commands.{arguments[0]}")
    for place, stage in stages.items():
        _replace(place, functools.partial(clocked, stage=stage))
    if arguments[0] == "build":
        # JAX traces what the first function returns, and the second.
        _replace(
            "uplift.fit.batch:_program",
            lambda make: functools.cache(lambda *given: _first(make(*given), clocked)),
        )
        _replace(
            "uplift.fit.kriging:_kernel_block",
            lambda function: _first(function, clocked),
        )
    times["imports"] = begin = time.process_time()
    command_line(arguments, prog_name="uplift", standalone_mode=False)
    times["rest"] = time.process_time() - begin - inner[0]
    return dict(times)


def _first(function: Function, clocked: Function) -> Function:
    """Count the first call of a function that JAX traces as a stage."""
    calls = iter([clocked(function, "tracing")])
    return lambda *given: next(calls, function)(*given)


def _replace(place: str, change: Function) -> None:
    """Replace a function, given as 'module:name' or 'module:Class.name'."""
    module, _, name = place.partition(":")
    *owner, name = name.split(".")
    target = functools.reduce(getattr, owner, importlib.import_module(module))
    setattr(target, name, change(getattr(target, name)))
