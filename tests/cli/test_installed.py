"""A package of another author adds an export and a command by entry points."""

import os
import sys

from tests.conftest import ROOT
from tests.helpers import output_of

MODULE = '''
import click

from uplift.extras.export.registry import Export

EXPORT = Export(".toy", "the colours of the entries, a line each", "toy_part:write")


def write(cube, path, style, *, force):
    path.write_text("".join(f"{name}\\n" for name in cube.atlas_names))
    return f"{len(cube.atlas_names)} names"


@click.command()
@click.argument("name")
def greet(name):
    """Greet a person."""
    click.echo(f"hello {name}")
'''
ENTRY_POINTS = """
[uplift.exports]
toy = toy_part:EXPORT

[uplift.commands]
greet = toy_part:greet
"""


def test_an_export_and_a_command_of_another_package(tmp_path):
    (tmp_path / "toy_part.py").write_text(MODULE)
    metadata = tmp_path / "toy_part-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Name: toy-part\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS)
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}

    def run(*words):
        command = [sys.executable, "-P", "-m", "uplift_cli", *words]
        return output_of(*command, cwd=tmp_path, env=environment)

    assert "colours of the entries" in run("export", "--help")
    cube = ROOT / "cubes" / "moments-8-macbeth.uplift"
    assert run("export", cube, "-o", "card.toy").startswith("card.toy: 23 names")
    assert "dark skin" in (tmp_path / "card.toy").read_text()
    assert "Other packages" in run()
    assert run("greet", "you") == "hello you\n"
