"""A package of another author adds an export and a command by entry points."""

import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT

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


@pytest.fixture
def run(tmp_path):
    (tmp_path / "toy_part.py").write_text(MODULE)
    metadata = tmp_path / "toy_part-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Name: toy-part\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY_POINTS)

    def run(*words):
        return subprocess.run(
            [sys.executable, "-P", "-m", "uplift_cli", *words],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout

    return run


def test_an_export_of_another_package(run, tmp_path):
    assert "colours of the entries" in run("export", "--help")
    cube = str(ROOT / "cubes" / "moments-8-macbeth.uplift")
    assert run("export", cube, "-o", "card.toy").startswith("card.toy: 23 names")
    assert "dark skin" in (tmp_path / "card.toy").read_text()


def test_a_command_of_another_package(run):
    assert "Other packages" in run()
    assert run("greet", "you") == "hello you\n"
