"""The moments study: its laws, and the statements of its page."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import uplift
from benchmarks.moments import FLOATS, max_moments, read_thesis
from tests.helpers import raises
from uplift.atlas import Atlas, read_atlas
from uplift.common.errors import AtlasError, OptionError
from uplift.common.progress import Progress
from uplift.lab.study.moments import ALL_ATLASES, MAX_MOMENTS, MEASURES, TECHNIQUES, study_moments

MW, MNW, NMW, NMNW = TECHNIQUES


@pytest.fixture(scope="module")
def full_study(repository):
    """Study of all shipped atlases."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return study_moments({path.stem: read_atlas(path) for path in sorted((repository / "atlases").glob("*.txt"))})


@pytest.fixture(params=["macbeth", ALL_ATLASES])
def errors(request, macbeth_study, full_study):
    """Function from technique, floats and measure to the mean error, for the ColorChecker and for all atlases."""
    study = full_study if request.param == ALL_ATLASES else macbeth_study
    return lambda technique, floats, measure=0: study.result(technique, max_moments(technique, floats)).mean[measure]


@pytest.mark.parametrize("technique", TECHNIQUES, ids=lambda technique: technique.short)
@pytest.mark.parametrize("measure", MEASURES)
def test_error_falls_with_moments(macbeth_study, technique, measure):
    column = MEASURES.index(measure)
    means = [macbeth_study.result(technique, count).mean[column] for count in range(16)]
    assert means[15] < means[4] < means[2] < means[0]
    assert means[8] < means[4]


@pytest.mark.parametrize("technique", TECHNIQUES, ids=lambda technique: technique.short)
def test_each_of_the_first_eight_moments_reduces_the_error(macbeth_study, technique):
    means = [macbeth_study.result(technique, count).mean[0] for count in range(9)]
    assert (np.diff(means) < 0).all()


def test_zero_moments_give_a_grey(macbeth_study):
    np.testing.assert_allclose(macbeth_study.errors[0, 0], macbeth_study.errors[2, 0], atol=1e-9)
    np.testing.assert_allclose(macbeth_study.errors[1, 0], macbeth_study.errors[3, 0], atol=1e-9)
    assert macbeth_study.result(MW, 0).mean[0] > 30


def test_mirrored_techniques_have_the_least_error(errors):
    for floats in FLOATS:
        best = min(TECHNIQUES, key=lambda technique: errors(technique, floats))
        assert best.mirrored, floats
    for floats in (9, 13, 16):
        rms = {technique: errors(technique, floats, MEASURES.index("rms")) for technique in TECHNIQUES}
        assert min(rms[NMW], rms[NMNW]) > 2.5 * min(rms[MW], rms[MNW])


def test_warping_has_the_least_error_with_few_floats(errors):
    """Of the four techniques, mirrored and warped is best at three to five coefficients."""
    for floats in (3, 4, 5):
        assert min(TECHNIQUES, key=lambda technique: errors(technique, floats)) == MW


def test_statements_of_the_page_on_warp_and_shape(full_study):
    warped, unwarped = (
        np.array([[full_study.result(one, count).mean, full_study.result(one, count).max] for count in range(16)])
        for one in (MW, MNW)
    )
    better = warped < unwarped
    floats = np.arange(16) + 1
    assert floats[better[:, 0, 0]].tolist() == [1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12]
    assert set(range(2, 15)) == set(floats[better[:, 1, 0]])
    assert better[8, 0, 1:-1].all()
    rms = [[full_study.result(one, max_moments(one, floats)).mean[-1] for one in TECHNIQUES] for floats in (9, 13, 16)]
    assert all(min(row[2:]) > 3 * min(row[:2]) for row in rms)
    assert not better[[floats - 1 for floats in FLOATS], 0, -1].any()


def test_statements_of_the_page_on_the_thesis(full_study):
    thesis = read_thesis()
    assert len(thesis) == 64
    for technique in (MW, MNW):
        assert full_study.result(technique, 8).mean[0] == pytest.approx(thesis[technique, 8][0], abs=0.2)
        assert full_study.result(technique, 8).max[0] == pytest.approx(thesis[technique, 8][1], abs=0.35)
    assert full_study.result(MW, 2).mean[0] > 5 * thesis[MW, 2][0]
    assert all(mean > 0.2 for mean, _ in thesis.values())
    assert full_study.result(NMNW, 15).mean[0] < 0.02


def test_groups_partition_the_entries(full_study):
    counts = [len(full_study.rows(group)) for group in full_study.groups]
    assert counts[0] == sum(counts[1:]) == 396
    worst = full_study.result(MW, 8)
    home = full_study.result(MW, 8, full_study.atlases[worst.worst])
    assert (home.worst, home.max[0]) == (worst.worst, worst.max[0])
    assert full_study.errors[0, 8, worst.worst, 0] == worst.max[0]


def test_results_of_an_atlas_do_not_depend_on_others(full_study, macbeth_study):
    np.testing.assert_allclose(
        full_study.errors[:, :, full_study.rows("macbeth")], macbeth_study.errors, rtol=0, atol=1e-9
    )


def test_progress_counts_reconstructions(repository):
    events = []
    study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, 2, events.append)
    assert events == [Progress("reconstructions", done, 12) for done in range(1, 13)]


@pytest.mark.parametrize("count", [-1, MAX_MOMENTS + 1])
def test_moments_out_of_range_raise(count, repository):
    with raises(OptionError, "moments-out-of-range") as caught:
        study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, count)
    assert f"[0, {MAX_MOMENTS}], got {count}" in str(caught.value)


def test_largest_number_of_moments_gives_finite_errors(repository):
    study = study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, MAX_MOMENTS)
    assert np.isfinite(study.errors).all()
    assert study.result(MNW, MAX_MOMENTS).max[0] < 0.1


def test_empty_atlases_raise():
    for atlases in ({}, {"empty": Atlas()}):
        with raises(AtlasError, "empty-atlas"):
            study_moments(atlases)


def test_duplicate_names_raise(repository):
    path = repository / "atlases" / "macbeth.txt"
    with raises(AtlasError, "atlas"):
        study_moments({"one": read_atlas(path), "two": read_atlas(path)})
