"""The study of the ColorChecker, once a run."""

from __future__ import annotations

import pytest

from uplift.atlas import read_atlas
from uplift.lab.study.moments import Study, study


@pytest.fixture(scope="session")
def macbeth_study(repository) -> Study:
    return study({"macbeth": read_atlas(repository / "atlases" / "macbeth.txt")})
