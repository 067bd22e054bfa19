"""Short campaigns of malformed cube files for ``uplift.h`` and ``uplift.js``."""

from tests.fuzz import header
from tests.parts import CC, NODE, SANITIZERS, need


def check(program, count, folder, monkeypatch):
    """Read mutants: files are refused or answered."""
    monkeypatch.setattr(header, "KEPT", folder / "kept")
    tally = header.run(program, range(count), folder)
    assert not tally["crash"]
    assert not tally[header.NOT_A_REFLECTANCE]
    assert tally["0"] > count / 10
    assert len(tally) > 3


def test_the_header_reads_malformed_files(tmp_path, monkeypatch):
    need(CC, SANITIZERS)
    check(header.compile_reader(tmp_path), 200, tmp_path, monkeypatch)


def test_the_module_reads_malformed_files(tmp_path, monkeypatch):
    """Its code is compiled from the header."""
    need(NODE)
    check(header.write_reader(tmp_path), 100, tmp_path, monkeypatch)
