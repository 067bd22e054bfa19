"""Outputs that are one file: by path, by links, and by upper and lower case."""

import os
from functools import partial

import pytest

from tests.helpers import raises
from uplift.common.errors import OutputError
from uplift.common.files import write_text
from uplift.extras.files import outputs
from uplift.extras.files.outputs import (
    check_folder,
    check_outputs,
    is_same_name,
    make_folder,
)
from uplift.samples import copy_samples

DECOMPOSED = "e\u0301.exr"
COMPOSED = "\u00e9.exr"
PAIRS = (("A.exr", "a.exr"), (COMPOSED, DECOMPOSED), ("In/a.exr", "in/a.exr"))
"""Names that some file systems, such as those of macOS and Windows, take for one."""


@pytest.fixture
def folding(monkeypatch):
    """A disk that does not distinguish them."""
    monkeypatch.setattr(outputs, "is_same_name", lambda path, other: True)


@pytest.mark.parametrize("names", PAIRS)
def test_names_that_the_disk_takes_for_one_are_refused(tmp_path, folding, names):
    with raises(OutputError, "output") as caught:
        check_folder(tmp_path / "out", names)
    assert caught.value.path == tmp_path / "out" / names[1]
    with raises(OutputError, "output"):
        check_outputs(tmp_path / name.replace("/", "") for name in names)
    check_folder(tmp_path / "out", ("a.exr", "b.exr"))
    with raises(OutputError, "output"):
        check_folder(tmp_path, ("a.exr", "a.exr"))


@pytest.mark.parametrize("names", PAIRS)
def test_the_disk_is_tried_and_left_empty(tmp_path, names):
    same = is_same_name(*(tmp_path / "missing" / name for name in names))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / os.path.dirname(names[0])).mkdir(exist_ok=True)
    (tmp_path / names[0]).touch()
    assert same == (tmp_path / names[1]).exists()


@pytest.mark.parametrize("write", [copy_samples, make_folder, partial(write_text, "x")])
def test_an_empty_name_is_not_the_current_folder(tmp_path, monkeypatch, write):
    monkeypatch.chdir(tmp_path)
    with raises(OutputError, "output"):
        write("")
    assert not list(tmp_path.iterdir())
