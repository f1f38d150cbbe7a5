"""The matte of one object of a file of layers, by the Cryptomatte node of Blender's compositor.

    blender --background --factory-startup --python docs/compositing/matte.py -- \
    LAYERS.exr NAME WIDTH HEIGHT MATTE.exr
"""

import os
import sys

import bpy

layers, name, width, height, matte = sys.argv[sys.argv.index("--") + 1:]
image = bpy.data.images.load(os.path.abspath(layers))
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.filepath = os.path.abspath(matte)
scene.use_nodes = True
nodes, links = scene.node_tree.nodes, scene.node_tree.links
nodes.clear()
cryptomatte = nodes.new("CompositorNodeCryptomatteV2")
cryptomatte.source = "IMAGE"
cryptomatte.image = image
cryptomatte.layer_name = "CryptoObject"
cryptomatte.matte_id = name
composite = nodes.new("CompositorNodeComposite")
composite.use_alpha = False
links.new(cryptomatte.outputs["Matte"], composite.inputs["Image"])
bpy.ops.render.render(write_still=True)
