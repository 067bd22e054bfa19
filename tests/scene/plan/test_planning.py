"""A complete plan, and its errors by an independent computation with numpy and colour-science."""

import json
import shutil
from dataclasses import replace

import colour
import numpy as np
import pytest

import uplift
from tests.helpers import raises
from tests.scene.plan.conftest import LIGHTS, SMALL, painted
from uplift import models
from uplift.colorimetry import observer
from uplift.common.errors import PlanFileError
from uplift.io.scene_colours import Images
from uplift.scene import plan
from uplift.scene.plan.plan_file import read_plan, to_json


def test_every_decision_selects_the_cheapest_candidate_within_its_limit(planned):
    found, _ = planned
    assert [each.key for each in found.decisions] == ["coefficients", "lattice", "wavelengths", "storage"]
    for decision in found.decisions:
        errors = [trial.error.quantile for trial in decision.trials]
        costs = [trial.cost for trial in decision.trials]
        assert costs == sorted(costs)
        if decision.within_limit:
            assert decision.selected == len(errors) - 1
            assert all(error > decision.limit for error in errors[:-1])
        else:
            assert errors[decision.selected] == min(errors)
    assert found.options["coefficients"] == int(found.decisions[0].trial.name)
    assert found.within_tolerance


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
def test_an_independent_computation_on_every_pixel_agrees(planned, kitchen):
    found, _ = planned
    rgb = painted().reshape(-1, 3).astype(float)
    scene, atlas = Images((kitchen.parent / "wood.exr",)), kitchen.parent / "macbeth.txt"
    options = {"lights": found.options["lights"]}
    best = uplift.build(atlas, scene=scene, dim=SMALL.reference, coefficients=9, **options)
    cube = uplift.build(atlas, scene=scene, **found.options)
    spectra = cube.reflectance(rgb, found.sampling.wavelengths)
    if found.storage.form == "moments":
        stored = cube.coefficients(rgb).astype(np.float16 if found.storage.depth == "half" else np.float32)
        spectra = models.reflectance(cube.data.model, stored.astype(float), found.sampling.wavelengths)
    for light in LIGHTS:
        white = colour.XYZ_to_xy(integrated(np.ones((1, 81)), light)[0])
        place = found.sampling.lights.index(light)
        planned_xyz = spectra * found.sampling.powers[place] @ found.sampling.to_xyz
        reference_xyz = integrated(best.reflectance(rgb), light)
        delta_e = colour.delta_E(
            *(colour.XYZ_to_Lab(xyz, white) for xyz in (reference_xyz, planned_xyz)), method="CIE 2000"
        )
        for error in (found.predicted, found.confirmed):
            (part,) = [each for each in error.parts if (each.group, each.light) == ("textures", light)]
            low, high = np.quantile(delta_e, (0.95, 0.99))  # quantiles of a sample of pixels vary
            assert 0.9 * low < part.quantile < 1.1 * high
            assert delta_e.mean() == pytest.approx(part.mean, rel=0.2)


def test_a_tolerance_below_the_error_of_the_reference_cube_is_refused(kitchen):
    scene = replace(plan.read_scene_file(kitchen), tolerance=0.01)
    with raises(PlanFileError) as caught:
        plan.plan(scene, replace(SMALL, coefficients=(5,)))
    assert "of materials under FL11, got 0.01" in caught.value.problem
    feasible = float(caught.value.hint.removeprefix("set tolerance = ").removesuffix(" or more"))
    assert feasible > 0.05
    assert caught.value.path == kitchen


@pytest.fixture
def plan_file(planned, kitchen, tmp_path):
    """Path of a plan file in a copy of the scene's folder, its values, and a function that writes them."""
    path = tmp_path / "copy" / "kitchen.plan.json"
    shutil.copytree(kitchen.parent, path.parent)
    values = to_json(planned[0], kitchen.parent / path.name)
    return path, values, lambda: path.write_text(json.dumps(values), encoding="utf-8")


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_the_plan_file_builds_the_same_cube(planned, plan_file):
    path, _, write = plan_file
    write()
    cube, final = read_plan(path).build(), planned[0].final_build
    np.testing.assert_array_equal(cube.data.points.coefficients, final.cube.data.points.coefficients)
    assert (cube.data.complete_cells is not None) == final.is_sparse


def test_changed_and_missing_sources_are_refused(plan_file):
    path, _, write = plan_file
    write()
    assert read_plan(path).textures == (path.parent / "wood.exr",)
    with (path.parent / "macbeth.txt").open("a", encoding="utf-8") as file:
        file.write("\n")
    with raises(PlanFileError, "source-changed") as caught:
        read_plan(path)
    assert "scene.atlases[0].path: 'macbeth.txt'" in caught.value.problem
    (path.parent / "wood.exr").unlink()
    with raises(PlanFileError, "file-not-found") as caught:
        read_plan(path)
    assert "scene.textures[0].path" in caught.value.problem
    assert "wood.exr" in caught.value.problem


@pytest.mark.parametrize(
    ("spoil", "code", "start"),
    [
        (lambda values: values.pop("build"), "invalid-file", "build"),
        (lambda values: values.update(format="uplift plan 2"), "invalid-file", "format"),
        (lambda values: values["build"].update(dims=3), "unknown-name", "build: unknown option 'dims'"),
        (lambda values: values["build"].update(dim="x"), "option", "build: dim "),
        (lambda values: values["build"].update(lights="D65"), "option", "build: lights "),
        (lambda values: values["scene"].update(textures=[3]), "invalid-file", "scene.textures[0]"),
        (lambda values: values["scene"]["textures"][0].pop("digest"), "invalid-file", "scene.textures[0].digest"),
    ],
)
def test_an_invalid_plan_is_refused_with_its_key(plan_file, spoil, code, start):
    path, values, write = plan_file
    spoil(values)
    write()
    with raises(PlanFileError, code) as caught:
        read_plan(path)
    assert caught.value.problem.startswith(start)
    assert caught.value.hint
