"""``uplift lab diff``."""

import pytest


@pytest.fixture
def cubes(home, small_cube, plain_cube):
    small_cube.save(home / "a.uplift")
    plain_cube.save(home / "b.uplift")
    return "a.uplift", "b.uplift"


def test_exit_code_by_tolerance(run, cubes):
    run("lab diff", *cubes)
    run("lab diff", *cubes, "--tolerance", "100", code=1)  # entries were removed
    run("lab diff a.uplift a.uplift --tolerance 0")


def test_json_and_page(ask, cubes, home):
    words = "--light A -o page.html --tolerance 1"
    figures = ask("lab diff", *cubes, *words.split(), code=1)
    assert figures["cubes"] == list(cubes)
    assert {row["light"] for row in figures["differences"]} == {"A"}
    assert len(figures["entries_removed"]) == 24
    assert (home / "page.html").read_text("utf-8").startswith("<!DOCTYPE html>")
