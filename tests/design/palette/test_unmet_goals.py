"""What cannot be had is told, with what would help."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from uplift.design.palette import design, misses
from uplift.design.palette.palette import Apart, Part, Wish


@pytest.fixture
def black(metamers):
    """A paint of at least 10 % that shall be black under the lamp, and grey by day."""
    wishes = (Wish("soot", "day", rgb=np.full(3, 0.2)), Wish("soot", "lamp", rgb=np.zeros(3)))
    return dataclasses.replace(metamers, materials=(Part("soot", None, 0.1, 1),), wishes=wishes, free={})


def test_a_wish_that_no_paint_fulfils_is_missed(black, model):
    missed = misses(design(black, model))
    (lamp,) = (miss for miss in missed if miss.wish is black.wishes[1])
    assert lamp.delta_e > 10
    assert str(lamp).startswith(
        f"soot under lamp: missed by ΔE00 {lamp.delta_e:.2f}; relax the bounds of soot"
    )


def test_what_it_says_would_help_helps(black, model):
    """Without bounds the wish is fulfilled, to the ΔE00 that was told."""
    lamp = misses(design(black, model))[-1]
    relief = next(one for one in lamp.reliefs if one.what == "the bounds of soot")
    wide = dataclasses.replace(black, materials=(Part("soot", None, -np.inf, np.inf),))
    left = misses(design(wide, model))
    assert relief.delta_e < 0.5
    assert not left


def test_wishes_that_contradict_one_another_name_one_another(metamers, model):
    """One paint under one light cannot be two colours, shared by two wishes."""
    paint = Part("paint", np.full(81, 0.4))
    wishes = (Wish("paint", "odd", rgb=np.full(3, 0.3)), Wish("ditto", "odd", rgb=np.array([0.1, 0.3, 0.3])))
    palette = dataclasses.replace(
        metamers,
        lights=(Part("odd", None, 0, np.inf),),
        materials=(paint, Part("ditto", paint.samples)),
        wishes=wishes,
        free={},
    )
    told = [str(miss) for miss in misses(design(palette, model))]
    assert len(told) == 2
    assert "relax the weight of ditto under odd" in told[0]
    assert "relax the weight of paint under odd" in told[1]


def test_nothing_is_missed_where_all_is_well(metamers, model):
    assert misses(design(metamers, model)) == ()


def test_materials_that_lie_nearer_than_asked_are_told(metamers, model):
    apart = Apart(("fox", "moss"), "day", 5.0)
    (miss,) = misses(design(dataclasses.replace(metamers, apart=(apart,)), model))
    assert str(miss).startswith("fox and moss under day: ΔE00 0.0")
    assert "not 5" in str(miss)


def test_what_has_no_weight_is_not_missed(black, model):
    idle = tuple(dataclasses.replace(wish, weight=0.0) for wish in black.wishes)
    assert misses(design(dataclasses.replace(black, wishes=idle), model)) == ()
