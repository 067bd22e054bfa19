"""Meyer 1988: the matrices, tables and figures of the paper, reproduced."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks import read_reference
from benchmarks.meyer import CHANNELS, errors_by_total, mean_error, run_trials
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import OptionError, UnknownNameError
from uplift.extras.scene.wavelengths import choose, choose_orders, grid, make_setup
from uplift.extras.scene.wavelengths.meyer import (
    allocations,
    channel_functions,
    combine_rules,
    cone_space,
    four_wavelength_rule,
    meyer,
    opponent_space,
    quadrature_rules,
)
from uplift.extras.scene.wavelengths.sampling import balanced, evaluate


def _matrix(space):
    rows = read_reference("meyer1988_matrices.csv")
    cells = [(row["X"], row["Y"], row["Z"]) for row in rows if row["space"] == space]
    return np.array(cells, dtype=float)


@pytest.fixture(scope="module")
def cmfs():
    return observer.matching_functions(observer.DEFAULT_OBSERVER, 380, 770, 1)


@pytest.fixture(scope="module")
def opponent(cmfs):
    return opponent_space(grid(), cmfs)[0]


@pytest.fixture(scope="module")
def setting_c(checker):
    return make_setup(checker, ["C"])


def test_matrices_equal_the_printed_ones(cmfs, opponent):
    assert_allclose(cone_space(grid(), cmfs), _matrix("SML"), atol=1.5e-4)
    assert_allclose(opponent, _matrix("AC1C2"), atol=1.5e-4)


def test_eigenvalues_equal_the_printed_ones(cmfs):
    printed = [
        float(row["eigenvalue"])
        for row in read_reference("meyer1988_matrices.csv")
        if row["eigenvalue"]
    ]
    assert_allclose(opponent_space(grid(), cmfs)[1], printed, rtol=3e-3)


def test_rules_equal_tables_1a_and_1b(cmfs, opponent):
    rules = quadrature_rules(opponent, grid(), cmfs)
    printed = read_reference("meyer1988_table1.csv")
    pairs = []
    undefined = []
    for channel, orders in zip(CHANNELS, rules, strict=True):
        for order, rule in orders.items():
            table = [
                row
                for row in printed
                if (row["channel"], row["order"]) == (channel, str(order))
            ]
            if isinstance(rule, str):
                undefined.append((channel, order))
                assert not table
                continue
            nodes = [float(row["wavelength"]) for row in table]
            assert_allclose(
                rule.nodes, nodes, atol=0.101, err_msg=f"{channel}, order {order}"
            )
            pairs += [
                (w, float(row["weight"]))
                for w, row in zip(rule.weights, table, strict=True)
            ]
    assert undefined == [("C1", n) for n in (1, 3, 5, 7, 9)] + [
        ("C2", n) for n in (4, 5, 6, 8)
    ]
    weights, as_printed = np.array(pairs).T
    factor = weights @ as_printed / (weights @ weights)
    assert_allclose(factor * weights, as_printed, atol=4e-4)


def test_four_wavelength_rule_equals_table_2(cmfs, opponent, setting_c):
    rules = quadrature_rules(opponent, grid(), cmfs)
    shared = four_wavelength_rule(channel_functions(opponent, grid(), cmfs))
    table = [row for row in read_reference("meyer1988_table2.csv") if row["row"] == "2"]
    nodes = np.concatenate([rule.nodes for rule in shared])
    weights = np.concatenate([rule.weights for rule in shared])
    assert_allclose(nodes, [float(row["wavelength"]) for row in table], atol=0.101)
    printed = np.array([float(row["weight"]) for row in table])
    assert_allclose(weights * (printed[0] / weights[0]), printed, atol=2e-4)
    # Our ColorChecker is another measurement than the paper's.
    for allocation, row in (
        (shared, "2"),
        ((rules[0][3], rules[1][2], rules[2][1]), "1"),
    ):
        expected = next(
            float(r["error"])
            for r in read_reference("meyer1988_table2.csv")
            if r["row"] == row
        )
        assert mean_error(setting_c, opponent, allocation) == pytest.approx(
            expected, rel=0.03
        )


def test_figure_6_opponent_space_needs_the_fewest_wavelengths(
    cmfs, opponent, setting_c
):
    """Averaged over all allocations of a total, as in the paper."""
    spaces = (opponent, cone_space(grid(), cmfs), np.eye(3))
    curves = [errors_by_total(*run_trials(setting_c, space)) for space in spaces]
    for total in range(4, 31):
        assert curves[0][total].mean() < min(
            curves[1][total].mean(), curves[2][total].mean()
        ), total


@pytest.mark.parametrize("count", [4, 5, 12])
def test_meyer_takes_the_best_allocation(smooth, count, opponent):
    chosen = meyer(smooth, count)
    assert len(chosen) == count
    assert_allclose((chosen.powers @ chosen.to_xyz)[:, 1], 1, rtol=1e-12)
    reached = evaluate(smooth, chosen).mean()
    for allocation in allocations(smooth, opponent, count):
        assert sum(map(len, allocation)) == count
        assert (
            evaluate(
                smooth, balanced(combine_rules(smooth, opponent, allocation))
            ).mean()
            >= reached
        )


def test_given_orders_have_the_wavelengths_of_the_paper(setting_c):
    """Table 2, first row: orders 3, 2 and 1."""
    printed = [456.4, 483.0, 490.9, 557.7, 631.4, 632.3]
    assert_allclose(
        choose_orders(setting_c, (3, 2, 1)).sampling.wavelengths, printed, atol=0.08
    )


def test_impossible_orders_are_refused(setting_c):
    with raises(OptionError, "undefined-rule"):
        choose_orders(setting_c, (3, 3, 2))
    for count in (1, 3, 31):
        with raises(OptionError, "undefined-rule"):
            choose(setting_c, count=count, method="meyer")
    with raises(OptionError):
        choose_orders(setting_c, (3, 11, 1))
    with raises(UnknownNameError, "unknown-name"):
        choose_orders(setting_c, (3, 2, 1), "rgb")
