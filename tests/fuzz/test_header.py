"""A short campaign of malformed cube files for ``uplift.h``."""

from tests.fuzz import header
from tests.parts import CC, SANITIZERS, need


def test_malformed_files_are_refused_or_answered(tmp_path, monkeypatch):
    need(CC, SANITIZERS)
    monkeypatch.setattr(header, "KEPT", tmp_path / "kept")
    tally = header.run(header.compile_reader(tmp_path), range(300), tmp_path)
    assert not tally["crash"]
    assert not tally[header.NOT_A_REFLECTANCE]
    assert tally["0"] > 30
    assert len(tally) > 3
