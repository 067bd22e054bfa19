"""Answers of other tools are checked before their time counts."""

import numpy as np
import pytest

from benchmarks.peers import check_share


def test_a_point_without_a_number_is_not_within_the_threshold():
    found = np.array([[0.5, 0.5, np.nan], [0.5, 0.5, 0.5]])
    target = np.full((2, 3), 0.5)
    assert check_share(found, target, least=0.5) == 0.5
    with pytest.raises(RuntimeError, match="wrong answer"):
        check_share(found, target, least=0.9)
