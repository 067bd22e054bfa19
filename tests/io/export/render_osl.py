"""Render a square of an OSL shader in Blender: render_osl.py SHADER.osl SIDE OUT.exr.

The colour ``found`` of the shader fills the image, one value per pixel. Runs in the Python of `make osl`.
"""

from __future__ import annotations

import sys

import bpy

# isort: split
import _cycles  # which bpy provides

program, side, out = sys.argv[1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.shading_system = True
scene.cycles.samples = 1
scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1.0
scene.render.resolution_x = scene.render.resolution_y = int(side)
scene.render.filepath = out
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.type, camera.data.ortho_scale, camera.location = "ORTHO", 2, (0, 0, 1)
square = bpy.data.meshes.new("square")
square.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
material = bpy.data.materials.new("material")
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
nodes.clear()
shader = nodes.new("ShaderNodeScript")
shader.mode, shader.filepath = "EXTERNAL", program.replace(".osl", ".oso")
if not _cycles.osl_compile(program, shader.filepath):
    sys.exit("the shader does not compile")
emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
found = shader.outputs.new("NodeSocketColor", "found", identifier="found")
links.new(found, emission.inputs["Color"])
links.new(emission.outputs[0], output.inputs["Surface"])
square.materials.append(material)
for each in (camera, bpy.data.objects.new("square", square)):
    scene.collection.objects.link(each)
scene.camera = camera
bpy.ops.render.render(write_still=True)
