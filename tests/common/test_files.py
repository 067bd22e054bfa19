"""Atomic writing: files are complete or absent."""

from __future__ import annotations

import contextlib
import errno
import os
import pathlib
import signal
import stat
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.helpers import raises
from uplift.common import files
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write, check_output, check_outputs

AS_ROOT = os.name == "nt" or not hasattr(os, "geteuid") or os.geteuid() == 0


def write(path, text, **options):
    with atomic_write(path, **options) as temporary:
        temporary.write_text(text)


def fail(path, error):
    with atomic_write(path, force=True) as temporary:
        temporary.write_text("half")
        raise error


def test_new_file_leaves_no_other_file(tmp_path):
    write(tmp_path / "new", "text")
    assert os.listdir(tmp_path) == ["new"]
    assert (tmp_path / "new").read_text() == "text"


def test_target_appears_when_the_block_ends(tmp_path):
    with atomic_write(tmp_path / "new") as temporary:
        temporary.write_text("half")
        assert temporary.parent == tmp_path
        assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_exception_keeps_the_old_file_and_removes_the_temporary_one(tmp_path, error):
    path = tmp_path / "old"
    path.write_text("old")
    with pytest.raises(error):
        fail(path, error)
    assert os.listdir(tmp_path) == ["old"]
    assert path.read_text() == "old"


def test_exception_creates_no_file(tmp_path):
    with pytest.raises(RuntimeError):
        fail(tmp_path / "new", RuntimeError)
    assert os.listdir(tmp_path) == []


def test_full_disk_is_reported(tmp_path):
    path = tmp_path / "old"
    path.write_text("old")
    with pytest.raises(OutputError) as caught, atomic_write(path, force=True):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert caught.value.code == "cannot-write"
    assert caught.value.where == str(path)
    assert "No space left on device" in caught.value.problem
    assert os.listdir(tmp_path) == ["old"]
    assert path.read_text() == "old"


def test_existing_file_is_replaced_only_with_force(tmp_path):
    path = tmp_path / "old"
    path.write_text("old")
    with raises(OutputError, "file-exists"):
        write(path, "new")
    assert path.read_text() == "old"
    write(path, "new", force=True)
    assert path.read_text() == "new"


@pytest.mark.parametrize("links", [True, False])
def test_file_that_appears_during_the_work_is_not_replaced(tmp_path, monkeypatch, links):
    if not links:

        def link(source, target):
            raise OSError(errno.EPERM, "Operation not permitted")

        monkeypatch.setattr(os, "link", link)
    path = tmp_path / "out.txt"
    for name in ("out-2.txt", "out-3.txt"):
        with raises(OutputError, "file-appeared") as caught, atomic_write(path) as temporary:
            temporary.write_text("ours")
            path.write_text("theirs")
        assert str(tmp_path / name) in caught.value.problem
        assert (tmp_path / name).read_text() == "ours"
        assert path.read_text() == "theirs"
        path.unlink()
    assert sorted(os.listdir(tmp_path)) == ["out-2.txt", "out-3.txt"]
    with atomic_write(path, force=True) as temporary:
        temporary.write_text("ours")
        path.write_text("theirs")
    assert path.read_text() == "ours"


@pytest.mark.skipif(os.name == "nt", reason="no modes on Windows")
@pytest.mark.parametrize("mode", [0o600, 0o444, 0o666, 0o200])
def test_replaced_file_keeps_its_permissions(tmp_path, mode):
    path = tmp_path / "old"
    path.write_text("old")
    path.chmod(mode)
    write(path, "new", force=True)
    assert stat.S_IMODE(path.stat().st_mode) == mode


@pytest.mark.skipif(not AS_ROOT or os.name == "nt", reason="only root gives files away")
def test_replaced_file_keeps_its_owner(tmp_path):
    path = tmp_path / "old"
    path.write_text("old")
    os.chown(path, 1234, 5678)
    write(path, "new", force=True)
    assert (path.stat().st_uid, path.stat().st_gid) == (1234, 5678)


def test_outputs_are_checked_before_any_is_written(tmp_path):
    (tmp_path / "last").write_text("old")
    with raises(OutputError, "file-exists"):
        check_outputs([tmp_path / "first", None, tmp_path / "last"])
    check_outputs([tmp_path / "first", None, tmp_path / "last"], inputs=[None, "macbeth"], force=True)
    for other in (tmp_path / "first", tmp_path / "none" / ".." / "first"):
        (tmp_path / "none").mkdir(exist_ok=True)
        with raises(OutputError, "duplicate-output"):
            check_outputs([tmp_path / "first", other])


def test_inputs_are_not_replaced(tmp_path):
    path = tmp_path / "in"
    path.write_text("")
    (tmp_path / "link").symlink_to(path)
    for output in (path, tmp_path / "link", tmp_path / "." / "in"):
        with raises(OutputError, "output-is-input"):
            check_output(output, inputs=[None, "none", path], force=True)


def test_temporary_files_can_be_removed_before_the_process_ends(tmp_path):
    with contextlib.suppress(OutputError), atomic_write(tmp_path / "new") as temporary:
        assert temporary.exists()
        files.remove_temporaries()
        assert not temporary.exists()
    assert os.listdir(tmp_path) == []


def test_check_leaves_no_trace(tmp_path):
    assert check_output(str(tmp_path / "new")) == tmp_path / "new"
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("force", [False, True])
def test_folder_is_not_a_regular_file(tmp_path, force):
    with raises(OutputError, "not-a-regular-file"):
        check_output(tmp_path, force=force)


@pytest.mark.parametrize("name", ["none/new", "file/new"])
def test_missing_folder_raises(tmp_path, name):
    (tmp_path / "file").write_text("")
    with raises(OutputError, "folder-missing"):
        check_output(tmp_path / name)


@pytest.mark.skipif(AS_ROOT, reason="root writes everywhere")
def test_folder_without_permission_raises(tmp_path):
    tmp_path.chmod(0o500)
    with raises(OutputError, "no-permission"):
        check_output(tmp_path / "new")
    tmp_path.chmod(0o700)


def test_folder_that_cannot_be_entered_raises(tmp_path, monkeypatch):
    def refuse(path, **options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(pathlib.Path, "stat", refuse)
    with raises(OutputError, "no-permission"):
        check_output(tmp_path / "closed" / "new")


@pytest.mark.parametrize("name", ["a\0b", "x" * 300])
def test_impossible_names_raise(tmp_path, name):
    for function in (check_output, lambda path: write(path, "")):
        with raises(OutputError, "invalid-file-name"):
            function(tmp_path / name)


@pytest.mark.parametrize("letter", ["x", "ü"])
def test_longest_names_of_the_file_system(tmp_path, letter):
    path = tmp_path / (letter * (255 // len(letter.encode())))
    write(path, "text")
    assert path.read_text() == "text"


@pytest.mark.skipif(os.name == "nt", reason="no umask on Windows")
@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_permissions_follow_the_umask(tmp_path, umask, mode):
    before = os.umask(umask)
    try:
        write(tmp_path / "new", "")
        assert os.umask(umask) == umask  # unchanged
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == mode


def test_link_is_kept_and_its_target_replaced(tmp_path):
    target, link = tmp_path / "far" / "target", tmp_path / "link"
    target.parent.mkdir()
    target.write_text("old")
    link.symlink_to(target)
    write(link, "new", force=True)
    assert link.is_symlink()
    assert target.read_text() == "new"
    assert not target.is_symlink()
    assert os.listdir(target.parent) == ["target"]


def test_dangling_link_creates_its_target(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "target")
    write(link, "new")
    assert link.is_symlink()
    assert (tmp_path / "target").read_text() == "new"


def test_loop_of_links_raises(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(link)
    with raises(OutputError, "invalid-file-name"):
        write(link, "new")
    assert os.listdir(tmp_path) == ["link"]


WRITE = """
import sys
from uplift.common.files import atomic_write
with atomic_write(sys.argv[1], force=True) as temporary:
    temporary.write_text("half")
    print(temporary, flush=True)
    input()
    temporary.write_text("complete")
"""


@pytest.fixture
def writer(tmp_path):
    """A process that writes to ``cube`` and waits for a line before it ends, and its temporary path."""
    command = [sys.executable, "-c", WRITE, str(tmp_path / "cube")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield process, process.stdout.readline().rstrip()
        process.kill()


@pytest.mark.skipif(os.name == "nt", reason="no locks on Windows")
def test_file_of_a_killed_writer_is_removed_by_the_next(tmp_path, writer):
    process, temporary = writer
    process.send_signal(signal.SIGKILL)
    process.wait()
    (tmp_path / ".cube.mine.part").write_text("not the name of a temporary file")
    assert os.path.exists(temporary)
    write(tmp_path / "other", "text")
    assert os.path.exists(temporary)  # removed only by a writer to the same path
    write(tmp_path / "cube", "new")
    assert sorted(os.listdir(tmp_path)) == [".cube.mine.part", "cube", "other"]
    assert (tmp_path / "cube").read_text() == "new"


@pytest.mark.skipif(os.name == "nt", reason="no locks on Windows")
def test_file_of_a_live_writer_stays(tmp_path, writer):
    process, temporary = writer
    write(tmp_path / "cube", "first")
    assert os.path.exists(temporary)
    assert (tmp_path / "cube").read_text() == "first"
    process.communicate("\n")
    assert process.returncode == 0
    assert os.listdir(tmp_path) == ["cube"]
    assert (tmp_path / "cube").read_text() == "complete"  # the last to finish wins


def test_dash_is_standard_output_unless_part_of_a_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with raises(OutputError, "standard-output"):
        write("-", "text")
    write(tmp_path / "-", "text")
    assert os.listdir(tmp_path) == ["-"]


@pytest.mark.parametrize("name", ["with blank", "grün 👍", "-x", "*?[a]", "a'b\"c", ".hidden", "line\nbreak"])
def test_unusual_names(tmp_path, name):
    for text in ("old", "new"):
        write(tmp_path / name, text, force=True)
    assert os.listdir(tmp_path) == [name]
    assert (tmp_path / name).read_text() == "new"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no such device")
def test_device_is_not_a_regular_file():
    with raises(OutputError, "not-a-regular-file"):
        check_output("/dev/full", force=True)


def test_threads_do_not_change_the_umask(tmp_path, monkeypatch):
    umask = os.umask

    def slow(mask):
        before = umask(mask)
        time.sleep(0.01)
        return before

    monkeypatch.setattr(os, "umask", slow)
    own = umask(0o027)
    try:
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda number: write(tmp_path / str(number), "text"), range(8)))
    finally:
        left = umask(own)
    assert left == 0o027
    assert {stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()} == {0o640}
