"""Fixture: the moments study of the ColorChecker, once per session."""

from __future__ import annotations

import pytest

from uplift.atlas import read_atlas
from uplift.lab.study.moments import MomentsStudy, study_moments


@pytest.fixture(scope="session")
def macbeth_study(repository) -> MomentsStudy:
    return study_moments({"macbeth": read_atlas(repository / "atlases" / "macbeth.txt")})
