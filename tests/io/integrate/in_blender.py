"""Render a shader on a square with Cycles: python in_blender.py SHADER.osl TEXTURE.exr IMAGE.exr

The texture has alpha before its multipliers.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import bpy

# The shader compiler needs a module of Blender's own Python.
OWN = Path(bpy.__file__).parents[3].glob("python/lib/python*/site-packages")
sys.path += map(str, OWN)


def main(shader: str, texture: str, image: str) -> None:
    shader, texture, image = map(os.path.abspath, (shader, texture, image))
    scene = bpy.context.scene
    scene.render.engine, scene.render.filepath = "CYCLES", image  # first, as it compiles the shader
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.object.data.materials.append(_material(shader, texture))
    scene.camera = _camera(scene)
    scene.cycles.shading_system, scene.cycles.samples, scene.cycles.use_denoising = True, 1, False
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.view_settings.view_transform = "Raw"
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.ops.render.render(write_still=True)


def _material(shader: str, texture: str) -> bpy.types.Material:
    """Return a material that emits the shader's reflectance."""
    material = bpy.data.materials.new("uplifted")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    kinds = ("ShaderNodeTexCoord", "ShaderNodeScript", "ShaderNodeEmission", "ShaderNodeOutputMaterial")
    place, script, emission, output = (tree.nodes.new(kind) for kind in kinds)
    script.mode, script.filepath = "EXTERNAL", shader
    script.inputs["texture_file"].default_value = texture
    script.inputs["first_channel"].default_value = 1
    tree.links.new(place.outputs["UV"], script.inputs["UV"])
    tree.links.new(script.outputs["reflectance"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs[0])
    return material


def _camera(scene: bpy.types.Scene) -> bpy.types.Object:
    """Return an orthographic camera above the square."""
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale = "ORTHO", 2
    found = bpy.data.objects.new("camera", camera)
    found.location = (0, 0, 2)
    scene.collection.objects.link(found)
    return found


if __name__ == "__main__":
    main(*sys.argv[1:])
