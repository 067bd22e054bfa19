"""Matrix products of compiled functions state their precision: on an accelerator JAX
would multiply matrices of float32 in TF32, with 10 bits.
"""

import json
import re
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.helpers import run_python

SOURCE = "uplift/common/compilation.py"
PRODUCT = re.compile(r"stablehlo\.dot_general.*")
USE = re.compile(r"@compiled\b|(?<!\w)compiled\(")
FULL = "precision = [HIGHEST, HIGHEST]"
USES = """
import json, sys
import jax, numpy as np
from uplift.common import compilation

jax.config.update("jax_dump_ir_to", sys.argv[1])
callers = set()
compiled = compilation.compiled

def record(function, **options):
    caller = sys._getframe(1).f_code.co_filename
    def traced(*arguments):
        callers.add(caller)
        return function(*arguments)
    return compiled(traced, **options)

compilation.compiled = record

import uplift
from tests.extras.paint.invented import invented, measured, plan
from tests.helpers import quiet_build
from uplift.extras.paint import fit_paints
from uplift.extras.paint.paint_advice import advise_samples

cube = quiet_build("macbeth", dim=3, space="ITU-R BT.2020")
rgb = np.full((4, 3), 0.5, np.float32)
uplift.bulk.spectra(cube, [500])(rgb)
traced = uplift.bulk.traceable(cube, [500])
sums = lambda rgb, traced: uplift.bulk.evaluate(traced, rgb).sum()
for transform in (jax.grad, jax.jacfwd):
    jax.jit(transform(sums))(rgb, traced)
paints = invented()
advise_samples(fit_paints(measured(paints, plan(paints))))
print(json.dumps(sorted(callers)))
"""


def products(text):
    return PRODUCT.findall(text)


@pytest.fixture(scope="module")
def lowered(tmp_path_factory):
    """The programs of a build, of queries and of a fit of paints, and the files that
    compiled them.
    """
    folder = tmp_path_factory.mktemp("programs")
    output = run_python(USES, folder, cwd=ROOT)
    return json.loads(output), [path.read_text() for path in folder.iterdir()]


def test_products_of_all_compiled_functions_are_in_full_precision(lowered):
    callers, programs = lowered
    files = [*ROOT.glob("uplift/**/*.py"), *ROOT.glob("cli/**/*.py")]
    source = {str(path) for path in files if USE.search(path.read_text())}
    assert set(callers) == source - {str(ROOT / SOURCE)}
    found = products("\n".join(programs))
    assert len(found) > 50
    assert [line for line in found if FULL not in line] == []


def test_nothing_else_compiles():
    """A plain ``jax.jit`` would leave the precision to the machine."""
    plain = re.compile(r"\b(p?jit|pmap|xmap)\b(?!`)")
    for folder in ("uplift", "cli", "benchmarks"):
        for path in Path(ROOT, folder).rglob("*.py"):
            text = re.sub(r'"""[\s\S]*?"""|#.*', "", path.read_text())
            if str(path) != str(ROOT / SOURCE):
                assert not plain.search(text), path
