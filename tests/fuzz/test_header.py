"""Short campaigns of malformed cube files for ``uplift.h`` and ``uplift.js``."""

from tests.fuzz import header
from tests.parts import CC, NODE, SANITIZERS, need


def check(program, folder, monkeypatch):
    """Read mutants: files are refused or answered."""
    monkeypatch.setattr(header, "KEPT", folder / "kept")
    tally = header.run(program, range(150), folder)
    assert not tally["crash"]
    assert not tally[header.NOT_A_REFLECTANCE]
    assert tally["0"] > 30
    assert len(tally) > 3


def test_the_header_reads_malformed_files(tmp_path, monkeypatch):
    need(CC, SANITIZERS)
    check(header.compile_reader(tmp_path), tmp_path, monkeypatch)


def test_the_module_reads_malformed_files(tmp_path, monkeypatch):
    need(NODE)
    check(header.write_reader(tmp_path), tmp_path, monkeypatch)
