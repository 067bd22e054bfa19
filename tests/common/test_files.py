"""Files are complete or absent, and never take the place of an input."""

import errno
import os
import stat

import pytest

from tests.helpers import raises
from uplift.common.errors import OutputError, TextureError
from uplift.common.files import (
    atomic_write,
    check_output,
    check_regular,
    file_digest,
    read_bytes,
    remove_temporaries,
)
from uplift.extras.files.outputs import check_outputs


def write(path, text, **options):
    with atomic_write(path, **options) as temporary:
        temporary.write_text(text)


def fail(path, error):
    with atomic_write(path, force=True) as temporary:
        temporary.write_text("half")
        assert temporary.parent == path.parent
        raise error


@pytest.mark.parametrize("old", ["", "old"])
@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_the_old_file_remains_after_an_exception(tmp_path, old, error):
    path = tmp_path / "file"
    if old:
        path.write_text(old)
    with pytest.raises(error):
        fail(path, error)
    assert os.listdir(tmp_path) == ["file"] * bool(old)
    assert not old or path.read_text() == old


def test_a_full_disk_is_an_error_of_the_output(tmp_path):
    with raises(OutputError, "output") as caught:
        fail(tmp_path / "new", OSError(errno.ENOSPC, "No space left on device"))
    assert caught.value.where == str(tmp_path / "new")
    assert "No space left on device" in caught.value.problem
    assert os.listdir(tmp_path) == []


def test_existing_file_is_replaced_only_with_force(tmp_path):
    path = tmp_path / "old"
    path.write_text("old")
    with raises(OutputError, "file-exists"):
        write(path, "new")
    assert path.read_text() == "old"


@pytest.mark.skipif(os.name == "nt", reason="no modes on Windows")
@pytest.mark.parametrize("mode", [0o600, 0o444])
def test_replaced_file_keeps_its_permissions(tmp_path, mode):
    path = tmp_path / "old"
    path.write_text("old")
    path.chmod(mode)
    write(path, "new", force=True)
    assert stat.S_IMODE(path.stat().st_mode) == mode


def test_outputs_are_checked_before_any_is_written(tmp_path):
    first, last = tmp_path / "first", tmp_path / "last"
    last.write_text("old")
    (tmp_path / "link").symlink_to(last)
    (tmp_path / "none").mkdir()
    same = tmp_path / "none" / ".." / "first"
    for outputs, options, code in (
        ([first, None, last], {}, "file-exists"),
        ([first, first], {}, "output"),
        ([first, same], {}, "output"),
        ([last], {"inputs": [None, "none", last], "force": True}, "output-is-input"),
        ([tmp_path / "link"], {"inputs": [last], "force": True}, "output-is-input"),
        ([tmp_path], {"force": True}, "output"),
        (["/dev/null"], {"force": True}, "output"),
    ):
        with raises(OutputError, code):
            check_outputs(outputs, **options)
    check_outputs([first, None, last], inputs=[None, "macbeth"], force=True)
    assert not first.exists()


def test_temporary_files_can_be_removed_before_the_process_ends(tmp_path):
    with raises(OutputError, "output"), atomic_write(tmp_path / "new"):
        remove_temporaries()
        assert os.listdir(tmp_path) == []


def test_file_of_a_killed_writer_is_removed_by_a_later_one(tmp_path):
    with atomic_write(tmp_path / "cube") as temporary:
        name = temporary.name
    for stale, age in (
        (name, 100_000),
        (".cube.now.part", 0),
        (".other.old.part", 100_000),
    ):
        (tmp_path / stale).write_text("half")
        changed = (tmp_path / stale).stat().st_mtime - age
        os.utime(tmp_path / stale, (changed, changed))
    write(tmp_path / "cube", "new", force=True)
    assert sorted(os.listdir(tmp_path)) == [".cube.now.part", ".other.old.part", "cube"]


@pytest.mark.parametrize("name", ["none/new", "file/new", "a\0b", "x" * 300, "loop"])
def test_impossible_names_raise(tmp_path, name):
    (tmp_path / "file").write_text("")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    for function in (check_output, lambda path: write(path, "")):
        with raises(OutputError, "output"):
            function(tmp_path / name)
    assert sorted(os.listdir(tmp_path)) == ["file", "loop"]


@pytest.mark.parametrize("exists", [True, False])
def test_link_is_kept_and_its_target_replaced(tmp_path, exists):
    target = tmp_path / "far" / "target"
    link = tmp_path / "link"
    target.parent.mkdir()
    if exists:
        target.write_text("old")
    link.symlink_to(target)
    write(link, "new", force=exists)
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert os.listdir(target.parent) == ["target"]


def test_dash_is_standard_output_unless_part_of_a_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with raises(OutputError, "output"):
        write("-", "text")
    write(tmp_path / "-", "text")
    assert os.listdir(tmp_path) == ["-"]


@pytest.mark.skipif(not os.path.exists("/proc/self"), reason="needs /proc")
def test_pipes_devices_and_files_of_the_kernel_are_not_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero", "/proc/kmsg", "/proc/self/status"):
        for read in (check_regular, read_bytes, file_digest):
            options = {
                check_regular: {"hint": ""},
                read_bytes: {"hint": "", "limit": 9},
            }.get(read, {})
            with raises(TextureError, "file-unreadable"):
                read(path, TextureError, **options)
