"""The moments study: its laws, and what its page says of it."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import uplift
from benchmarks.moments import FLOATS, max_moments, read_thesis
from uplift.atlas import Atlas, read_atlas
from uplift.common.errors import AtlasError, OptionError
from uplift.lab.study.moments import ALL_ATLASES, MAX_MOMENTS, MEASURES, study_moments
from uplift.lab.study.technique import TECHNIQUES

MW, MNW, NMW, NMNW = TECHNIQUES


@pytest.fixture(scope="module")
def whole_study(repository):
    """All shipped atlases."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return study_moments(
            {path.stem: read_atlas(path) for path in sorted((repository / "atlases").glob("*.txt"))}
        )


@pytest.fixture(params=["macbeth", ALL_ATLASES])
def errors(request, macbeth_study, whole_study):
    """Mean errors of the ColorChecker and of everything by technique, floats and measure."""
    found = whole_study if request.param == ALL_ATLASES else macbeth_study
    return lambda technique, floats, measure=0: found.of(technique, max_moments(technique, floats)).mean[
        measure
    ]


@pytest.mark.parametrize("technique", TECHNIQUES, ids=lambda technique: technique.short)
@pytest.mark.parametrize("measure", MEASURES)
def test_more_moments_are_nearer(macbeth_study, technique, measure):
    column = MEASURES.index(measure)
    means = [macbeth_study.of(technique, count).mean[column] for count in range(16)]
    assert means[15] < means[4] < means[2] < means[0]
    assert means[8] < means[4]


@pytest.mark.parametrize("technique", TECHNIQUES, ids=lambda technique: technique.short)
def test_each_of_the_first_eight_moments_helps(macbeth_study, technique):
    means = [macbeth_study.of(technique, count).mean[0] for count in range(9)]
    assert (np.diff(means) < 0).all()


def test_nothing_kept_is_a_grey_far_from_the_colours(macbeth_study):
    np.testing.assert_allclose(macbeth_study.errors[0, 0], macbeth_study.errors[2, 0], atol=1e-9)
    np.testing.assert_allclose(macbeth_study.errors[1, 0], macbeth_study.errors[3, 0], atol=1e-9)
    assert macbeth_study.of(MW, 0).mean[0] > 30


def test_mirroring_wins(errors):
    for floats in FLOATS:
        best = min(TECHNIQUES, key=lambda technique: errors(technique, floats))
        assert best.mirrored, floats
    for floats in (9, 13, 16):
        rms = {technique: errors(technique, floats, MEASURES.index("rms")) for technique in TECHNIQUES}
        assert min(rms[NMW], rms[NMNW]) > 2.5 * min(rms[MW], rms[MNW])


def test_warping_wins_with_few_floats(errors):
    """Of the thesis's four, mirrored and warped is best at three to five coefficients."""
    for floats in (3, 4, 5):
        assert min(TECHNIQUES, key=lambda technique: errors(technique, floats)) == MW


def test_the_page_s_words_on_warp_and_shape(whole_study):
    warped, unwarped = (
        np.array([[whole_study.of(one, count).mean, whole_study.of(one, count).most] for count in range(16)])
        for one in (MW, MNW)
    )
    ahead = warped < unwarped
    floats = np.arange(16) + 1
    assert floats[ahead[:, 0, 0]].tolist() == [1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12]
    assert set(range(2, 15)) == set(floats[ahead[:, 1, 0]])
    assert ahead[8, 0, 1:-1].all()
    rms = [
        [whole_study.of(one, max_moments(one, floats)).mean[-1] for one in TECHNIQUES]
        for floats in (9, 13, 16)
    ]
    assert all(min(row[2:]) > 3 * min(row[:2]) for row in rms)
    assert not ahead[[floats - 1 for floats in FLOATS], 0, -1].any()


def test_the_page_s_words_on_the_thesis(whole_study):
    thesis = read_thesis()
    assert len(thesis) == 64
    for technique in (MW, MNW):
        assert whole_study.of(technique, 8).mean[0] == pytest.approx(thesis[technique, 8][0], abs=0.2)
        assert whole_study.of(technique, 8).most[0] == pytest.approx(thesis[technique, 8][1], abs=0.35)
    assert whole_study.of(MW, 2).mean[0] > 5 * thesis[MW, 2][0]
    assert all(mean > 0.2 for mean, _ in thesis.values())
    assert whole_study.of(NMNW, 15).mean[0] < 0.02


def test_groups_make_up_the_whole(whole_study):
    counts = [len(whole_study.rows(group)) for group in whole_study.groups]
    assert counts[0] == sum(counts[1:]) == 396
    worst = whole_study.of(MW, 8)
    home = whole_study.of(MW, 8, whole_study.atlases[worst.worst])
    assert (home.worst, home.most[0]) == (worst.worst, worst.most[0])
    assert whole_study.errors[0, 8, worst.worst, 0] == worst.most[0]


def test_an_atlas_alone_is_as_among_others(whole_study, macbeth_study):
    np.testing.assert_allclose(
        whole_study.errors[:, :, whole_study.rows("macbeth")], macbeth_study.errors, rtol=0, atol=1e-9
    )


def test_progress_is_told(repository):
    told = []
    study_moments(
        {"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, 2, lambda *counts: told.append(counts)
    )
    assert told == [(done, 12) for done in range(1, 13)]


@pytest.mark.parametrize("most", [-1, MAX_MOMENTS + 1])
def test_moments_out_of_range_are_refused(most, repository):
    with pytest.raises(OptionError, match=f"{most} moments are out of range; take 0 to {MAX_MOMENTS}"):
        study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, most)


def test_the_most_moments_work(repository):
    found = study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, MAX_MOMENTS)
    assert np.isfinite(found.errors).all()
    assert found.of(MNW, MAX_MOMENTS).most[0] < 0.1


def test_nothing_to_study_is_refused():
    for atlases in ({}, {"empty": Atlas()}):
        with pytest.raises(AtlasError, match="no entries to study; name an atlas"):
            study_moments(atlases)


def test_names_that_two_atlases_share_are_refused(repository):
    path = repository / "atlases" / "macbeth.txt"
    with pytest.raises(AtlasError, match="the name is taken"):
        study_moments({"one": read_atlas(path), "two": read_atlas(path)})
