"""Recipes: their numbers decode as the decoder does."""

import re
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.extras.scene.passes.decoder import decoder as make_decoder
from uplift.extras.scene.passes.recipe import RECIPES

NUMBERS = np.array([0.3, 0.5, 0.2, 0.9, 0.4, 0.7])


@pytest.fixture
def decoder(two_passes):
    """A decoder to ACEScg."""
    return make_decoder(two_passes, space="ACEScg")


@pytest.mark.parametrize(
    ("tool", "row"),
    [
        ("text", r"[RGB] = (\S+) R (\S+) G (\S+) B"),
        ("nuke", r"\{(-?[\d.]+) (-?[\d.]+) (-?[\d.]+)\}"),
    ],
)
def test_texts_have_the_matrices(decoder, tool, row):
    text = RECIPES[tool](decoder)
    matrices = np.array(re.findall(row, text), dtype=float).reshape(2, 3, 3)
    assert_allclose(np.concatenate(matrices, axis=1), decoder.matrix, atol=1e-6)
    assert text.count("Merge2") == (tool == "nuke")
    assert text.count("{") == text.count("}")


class Socket:
    """A socket of a node."""

    default_value = 0.0


@pytest.mark.parametrize("math", ["CompositorNodeMath", "ShaderNodeMath"])
def test_blender(decoder, monkeypatch, math):
    """The script makes nodes that compute the picture."""
    nodes = []
    links = {}
    tree = MagicMock()
    tree.links.new = lambda source, target: links.update({target: source})

    def new_node(kind):
        inputs = [Socket(), Socket(), Socket()]
        outputs = [Socket(), Socket(), Socket()]
        nodes.append(SimpleNamespace(kind=kind, inputs=inputs, outputs=outputs))
        return nodes[-1]

    tree.nodes.new = new_node

    def value(socket):
        """The number of an input, as the compositor computes it."""
        if socket not in links:
            return socket.default_value
        source = links[socket]
        [node] = (node for node in nodes if source in node.outputs)
        place = node.outputs.index(source)
        if node.kind == "NodeGroupInput":
            return NUMBERS.reshape(2, 3)[place]
        first, second, third = map(value, node.inputs)
        if node.kind == "CompositorNodeSeparateColor":
            return first[place]
        if node.kind == "CompositorNodeCombineColor":
            return first, second, third
        assert (node.kind, node.operation) == (math, "MULTIPLY_ADD")
        return first * second + third

    types = SimpleNamespace(**{math: None})
    bpy = SimpleNamespace(data=MagicMock(), types=types)
    bpy.data.node_groups.new.return_value = tree
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    exec(RECIPES["blender"](decoder), {})
    [leave] = (node for node in nodes if node.kind == "NodeGroupOutput")
    assert_allclose(value(leave.inputs[0]), decoder.matrix @ NUMBERS, atol=1e-6)
