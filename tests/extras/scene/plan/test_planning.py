"""A complete plan, and its errors by an independent computation with numpy and
colour-science.
"""

import json
import shutil
from dataclasses import asdict, replace

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.extras.scene.plan.conftest import LIGHTS, SMALL, painted
from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises
from uplift import models
from uplift.colorimetry import observer
from uplift.common.errors import OutputError, PlanFileError
from uplift.extras.scene import plan
from uplift.extras.scene.plan.files import read_plan
from uplift.extras.scene.plan.planning import no_candidate
from uplift.extras.scene.plan.summary import check_path, notes, to_json
from uplift.extras.texture.scene_colours import Images


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
    assert found.within_tolerance
    assert found.chosen in found.front
    rgb = painted().reshape(-1, 3).astype(float)
    scene = Images((kitchen.parent / "wood.exr",))
    atlas = kitchen.parent / "macbeth.txt"
    best = uplift.build(
        atlas, scene=scene, dim=SMALL.reference, coefficients=9, lights=LIGHTS
    )
    cube = uplift.build(atlas, scene=scene, **asdict(found.chosen.cube))
    sampling = found.chosen.rendering.sampling
    spectra = cube.reflectance(rgb, sampling.wavelengths)
    if found.chosen.pixel.form == "moments":
        stored = cube.coefficients(rgb).astype(
            np.float16 if found.chosen.pixel.depth == "half" else np.float32
        )
        spectra = models.reflectance(
            cube.data.model, stored.astype(float), sampling.wavelengths
        )
    for light in LIGHTS:
        white = colour.XYZ_to_xy(integrated(np.ones((1, 81)), light)[0])
        planned_xyz = (
            spectra * sampling.powers[sampling.lights.index(light)] @ sampling.to_xyz
        )
        reference_xyz = integrated(best.reflectance(rgb), light)
        delta_e = colour.delta_E(
            *(colour.XYZ_to_Lab(xyz, white) for xyz in (reference_xyz, planned_xyz)),
            method="CIE 2000",
        )
        for error in (found.chosen.error, found.confirmed):
            (part,) = [
                each
                for each in error.parts
                if (each.group, each.light) == ("textures", light)
            ]
            low, high = np.quantile(
                delta_e, (0.95, 0.99)
            )  # quantiles of a sample of pixels vary
            assert 0.9 * low < part.quantile < 1.1 * high
            assert delta_e.mean() == pytest.approx(part.mean, rel=0.2)


def test_without_a_candidate_the_error_names_what_is_missing(planned):
    found, _ = planned
    error = no_candidate(replace(found.scene, tolerance=0.02), found.measured)
    feasible = float(
        error.hint.removeprefix("set tolerance = ").removesuffix(" or more")
    )
    assert feasible >= min(each.error.quantile for each in found.measured)
    error = no_candidate(
        replace(found.scene, limits={"samples": 2, "memory": 1e9}), found.measured
    )
    assert (error.code, error.path) == ("no-candidate", found.scene.path)
    assert (
        error.problem
        == "no candidate: the cheapest within 3 needs 5 samples; limits allow 2 samples"
    )


def planned_for(tmp_path, rgb, lights=LIGHTS, **values):
    path = write_exr(tmp_path / "a.exr", planes(np.asarray(rgb, np.float32)))
    scene = plan.SceneFile(tmp_path / "a.toml", (path,), lights=lights, **values)
    return plan.plan(scene, SMALL)


def test_a_tolerance_that_no_candidate_meets_is_refused(tmp_path):
    with raises(PlanFileError, "no-candidate"):
        planned_for(tmp_path, np.zeros((20, 20, 3)) + 0.3, limits={"samples": 2})


def test_a_scene_under_the_light_of_its_space_needs_no_spectra(tmp_path):
    found = planned_for(tmp_path, painted(), ("D65",))
    assert found.chosen.rendering is None
    assert found.confirmed.quantile < 1e-3
    assert "no spectra" in " ".join(notes(found))
    path = tmp_path / "a.plan.json"
    values = to_json(found, path)
    matrix = np.array(values["rendering"]["rgb_to_xyz"]["D65"])
    assert_allclose(matrix, np.linalg.inv(found.scene.sensor().xyz_to_rgb), atol=1e-6)
    assert not values["lines"]
    path.write_text(json.dumps(values), encoding="utf-8")
    with raises(PlanFileError) as caught:
        read_plan(path)
    assert "needs no cube" in caught.value.problem


def test_black_images_need_no_texture(tmp_path):
    found = planned_for(
        tmp_path, np.zeros((60, 80, 3)), tolerance=0.3, minimise="memory"
    )
    candidate = found.chosen
    assert found.within_tolerance
    assert candidate.pixel.form == "index"


def test_a_list_of_spectra_is_written(tmp_path):
    rgb = np.repeat(
        [[[0.6, 0.1, 0.05], [0.05, 0.3, 0.6], [0.3, 0.6, 0.1]]], 500, axis=0
    )
    found = planned_for(tmp_path, rgb, ("D65", "A", "FL11"), tolerance=1.0)
    assert found.chosen.pixel.form == "index"
    values = to_json(found, tmp_path / "a.plan.json")
    assert len(values["spectra"]) == 3
    spectra = np.array([each["reflectance"] for each in values["spectra"]])
    rendering = values["rendering"]
    xyz = spectra * np.array(rendering["powers"]["D65"]) @ np.array(rendering["to_xyz"])
    listed = np.array([each["rgb"] for each in values["spectra"]])
    assert_allclose(
        xyz, listed @ np.linalg.inv(found.scene.sensor().xyz_to_rgb).T, atol=0.02
    )


@pytest.fixture
def plan_file(planned, kitchen, tmp_path):
    """Path of a plan file in a copy of the scene's folder, its values, and a function
    that writes them.
    """
    path = tmp_path / "copy" / "kitchen.plan.json"
    shutil.copytree(kitchen.parent, path.parent)
    values = to_json(planned[0], kitchen.parent / path.name)
    return path, values, lambda: path.write_text(json.dumps(values), encoding="utf-8")


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_the_plan_file_builds_the_cube_whose_cost_was_estimated(planned, plan_file):
    path, _, write = plan_file
    write()
    cube = read_plan(path).build()
    chosen = planned[0].chosen
    assert (cube.data.lattice.dim, cube.data.model.count) == (
        chosen.cube.dim,
        chosen.cube.coefficients,
    )
    assert cube.data.is_sparse == chosen.sparse
    cube.save(path.with_suffix(".uplift"))
    pixels = 20 * 20 * chosen.pixel.size(0, int(chosen.cost.samples))
    assert chosen.cost.memory == pytest.approx(
        path.with_suffix(".uplift").stat().st_size + pixels, rel=0.25
    )


def test_changed_and_missing_sources_are_refused(plan_file):
    path, _, write = plan_file
    write()
    assert read_plan(path).images.paths == (path.parent / "wood.exr",)
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


def test_a_plan_is_written_where_it_can_be_read(planned, kitchen, tmp_path):
    found = planned[0]
    above = to_json(found, kitchen.parent.parent / "a.plan.json")["scene"]
    assert [each["path"] for each in above["textures"]] == [
        f"{kitchen.parent.name}/wood.exr"
    ]
    check_path(found.scene, kitchen.with_name("b.plan.json"))
    for write in (
        lambda path: check_path(found.scene, path),
        lambda path: to_json(found, path),
    ):
        with raises(OutputError, "output") as caught:
            write(tmp_path / "a.plan.json")
        assert str(kitchen.with_name("kitchen.plan.json")) in caught.value.hint


@pytest.mark.parametrize(
    ("spoil", "code", "start"),
    [
        (lambda values: values.pop("build"), "invalid-file", "build"),
        (
            lambda values: values.update(format="uplift plan 2"),
            "invalid-file",
            "format",
        ),
        (
            lambda values: values["build"].update(dims=3),
            "unknown-name",
            "build: unknown option 'dims'",
        ),
        (lambda values: values["build"].update(dim="x"), "option", "build: dim "),
        (lambda values: values["build"].update(lights=3), "option", "build: lights "),
        (
            lambda values: values["build"].update(
                observer="/etc/a.csv", space="camera"
            ),
            "unknown-name",
            "build: unknown",
        ),
        (
            lambda values: values["scene"].update(textures=[3]),
            "invalid-file",
            "scene.textures[0]",
        ),
        (
            lambda values: values["scene"]["textures"][0].pop("digest"),
            "invalid-file",
            "scene.textures[0].digest",
        ),
        (
            lambda values: values["scene"]["atlases"][0].update(path="../a.txt"),
            "invalid-file",
            "scene.atlases[0].path must lie in the folder",
        ),
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
