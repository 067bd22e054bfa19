"""Outputs that are one file: by path, by links, and by upper and lower case."""

from functools import partial

import pytest

from tests.helpers import raises
from uplift.common.errors import OutputError
from uplift.common.files import write_text
from uplift.extras.files import outputs
from uplift.extras.files.outputs import check_folder, is_same_name, make_folder
from uplift.samples import copy_samples

DECOMPOSED = "e\u0301.exr"
COMPOSED = "\u00e9.exr"
PAIRS = (("A.exr", "a.exr"), (COMPOSED, DECOMPOSED), ("In/a.exr", "in/a.exr"))
"""Names that some file systems, such as those of macOS and Windows, take for one."""


@pytest.mark.parametrize("names", [*PAIRS, ("a.exr", "a.exr")])
def test_names_that_the_disk_takes_for_one_are_refused(tmp_path, monkeypatch, names):
    monkeypatch.setattr(outputs, "is_same_name", lambda path, other: True)
    folder = tmp_path / "out"
    with raises(OutputError, "output") as caught:
        check_folder(folder, names)
    assert caught.value.path == folder / names[1]
    check_folder(folder, ("a.exr", "b.exr"))


@pytest.mark.parametrize("names", PAIRS)
def test_the_disk_is_tried_and_left_empty(tmp_path, names):
    same = is_same_name(*(tmp_path / "missing" / name for name in names))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / names[0]).parent.mkdir(exist_ok=True)
    (tmp_path / names[0]).touch()
    assert same == (tmp_path / names[1]).exists()


@pytest.mark.parametrize("write", [copy_samples, make_folder, partial(write_text, "x")])
def test_an_empty_name_is_not_the_current_folder(tmp_path, monkeypatch, write):
    monkeypatch.chdir(tmp_path)
    with raises(OutputError, "output"):
        write("")
    assert not list(tmp_path.iterdir())
