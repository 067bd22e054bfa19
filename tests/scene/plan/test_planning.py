"""A whole plan: the least that will do, confirmed; the same by plain numpy and colour-science."""

from __future__ import annotations

import shutil
import warnings
from dataclasses import replace

import colour
import numpy as np
import pytest

import uplift
from tests.scene.plan.conftest import LIGHTS, SMALL, painted
from uplift import models
from uplift.colorimetry import observer
from uplift.common.errors import PlanFileError
from uplift.io.scene_colours import Images
from uplift.scene import plan


def test_what_is_decided_is_the_least_that_stays_within_its_share(planned):
    found, _ = planned
    assert [each.key for each in found.chain] == ["coefficients", "lattice", "wavelengths", "storage"]
    for decision in found.decisions:
        errors = [trial.error.quantile for trial in decision.trials]
        costs = [trial.cost for trial in decision.trials]
        assert costs == sorted(costs)
        if decision.kept:
            assert decision.taken == len(errors) - 1
            assert all(error > decision.limit for error in errors[:-1])
        else:
            assert errors[decision.taken] == min(errors)
    assert found.options["coefficients"] == int(found.decisions[0].trial.name)
    assert found.within_tolerance


def test_the_steps_are_told(planned):
    _, steps = planned
    told = [step.stage for step in steps]
    assert told[0] == "textures"
    assert {"5 coefficients", "building it", "confirming"} <= set(told)
    assert all(0 <= step.done < step.total for step in steps)


def integrated(reflectances, light):
    shape = colour.SpectralShape(380, 780, 5)
    return (
        colour.colorimetry.msds_to_XYZ_integration(
            reflectances,
            cmfs=colour.MSDS_CMFS[observer.DEFAULT_OBSERVER].copy().align(shape),
            illuminant=colour.SDS_ILLUMINANTS[light].copy().align(shape),
            shape=shape,
        )
        / 100
    )


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_an_independent_computation_of_every_pixel_confirms_it(planned, kitchen):
    found, _ = planned
    rgb = painted().reshape(-1, 3).astype(float)
    scene, atlas = Images((kitchen.parent / "wood.exr",)), kitchen.parent / "macbeth.txt"
    options = {"lights": found.options["lights"]}
    best = uplift.build(atlas, scene=scene, dim=SMALL.reference, coefficients=9, **options)
    cube = uplift.build(atlas, scene=scene, **found.options)
    answered = cube.reflectance(rgb, found.sampling.wavelengths)
    if found.storage.form == "moments":
        held = cube.coefficients(rgb).astype(np.float16 if found.storage.depth == "half" else np.float32)
        answered = models.reflectance(cube.data.model, held.astype(float), found.sampling.wavelengths)
    for light in LIGHTS:
        white = colour.XYZ_to_xy(integrated(np.ones((1, 81)), light)[0])
        place = found.sampling.lights.index(light)
        seen = answered * found.sampling.powers[place] @ found.sampling.to_xyz
        wanted = integrated(best.reflectance(rgb), light)
        apart = colour.delta_E(*(colour.XYZ_to_Lab(xyz, white) for xyz in (wanted, seen)), method="CIE 2000")
        for error in (found.predicted, found.confirmed):
            (part,) = [each for each in error.parts if (each.group, each.light) == ("textures", light)]
            assert np.quantile(apart, 0.975) == pytest.approx(part.quantile, rel=0.2)


def test_a_tolerance_out_of_reach_is_refused_with_the_best_measured(kitchen):
    scene = replace(plan.read_scene_file(kitchen), tolerance=0.01)
    with pytest.raises(
        PlanFileError, match=r"no cube comes within ΔE00 0.01: the best measured has "
    ) as caught:
        plan.plan(scene, replace(SMALL, coefficients=(5,)))
    hint = caught.value.hint
    assert "of materials under FL11" in str(caught.value)
    assert float(hint.removeprefix("set tolerance = ").removesuffix(" or more")) > 0.1


def test_what_was_built_is_what_the_file_builds(planned, kitchen, tmp_path):
    found, _ = planned
    shutil.copytree(kitchen.parent, tmp_path / "moved")
    path = tmp_path / "moved" / "kitchen.plan.json"
    write(path, plan.to_json(found, kitchen.parent / "kitchen.plan.json"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        cube = plan.read_plan(path).build()
    np.testing.assert_array_equal(
        cube.data.points.coefficients, found.final_build.cube.data.points.coefficients
    )
    assert (cube.data.complete_cells is not None) == found.final_build.is_sparse


def write(path, said):
    from uplift_cli.output.console import json_text

    path.write_text(json_text(said), encoding="utf-8")


@pytest.fixture
def record(planned, kitchen, tmp_path):
    """The plan's file, and what it says; in a copy of its folder."""
    shutil.copytree(kitchen.parent, tmp_path / "copy")
    return tmp_path / "copy" / "kitchen.plan.json", plan.to_json(
        planned[0], kitchen.parent / "kitchen.plan.json"
    )


def test_a_plan_whose_sources_changed_is_refused(record):
    path, said = record
    write(path, said)
    assert plan.read_plan(path).textures == (path.parent / "wood.exr",)
    with (path.parent / "macbeth.txt").open("a", encoding="utf-8") as file:
        file.write("\n")
    with pytest.raises(
        PlanFileError, match=r"macbeth.txt has changed since the plan was measured; plan again"
    ):
        plan.read_plan(path)
    (path.parent / "wood.exr").unlink()
    with pytest.raises(PlanFileError, match=r"there is no file .*wood.exr; bring it back, or plan again"):
        plan.read_plan(path)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda said: said.pop("build"),
        lambda said: said.update(format="uplift plan 2"),
        lambda said: said["build"].update(dims=3),
        lambda said: said["build"].update(coefficients=99),
        lambda said: said["scene"].update(textures=[3]),
    ],
)
def test_what_is_no_plan_is_refused(record, spoil):
    path, said = record
    spoil(said)
    write(path, said)
    with pytest.raises(PlanFileError, match="is no plan of this version; plan again"):
        plan.read_plan(path)


def test_files_that_are_none_are_refused(tmp_path):
    with pytest.raises(PlanFileError, match=r"cannot be read: .*; make it: uplift plan"):
        plan.read_plan(tmp_path / "none.json")
    (tmp_path / "list.json").write_text("[1]")
    with pytest.raises(PlanFileError, match="is no plan of this version"):
        plan.read_plan(tmp_path / "list.json")
