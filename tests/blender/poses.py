# Makes an animated file, and the same at some frames with all vertices as Blender has them there:
#   blender -b --factory-startup --python poses.py -- FOLDER
# A cylinder is bent by two bones and swollen by a shape key; a cube below a turning parent has a
# shape key of its own. The pictures are 24 a second.
import math
import os
import sys

import bpy

FRAMES = [1, 7, 13, 25]


def key_bone(bone, frame, angle):
    bone.rotation_mode = 'QUATERNION'
    bone.rotation_quaternion = (math.cos(angle / 2), math.sin(angle / 2), 0, 0)
    bone.keyframe_insert('rotation_quaternion', frame=frame)


def add_bent_cylinder():
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.5, depth=4, location=(0, 0, 2))
    cylinder = bpy.context.object
    bpy.ops.object.mode_set(mode='EDIT')
    bpy.ops.mesh.select_all(action='SELECT')
    bpy.ops.mesh.subdivide(number_cuts=4)
    bpy.ops.object.mode_set(mode='OBJECT')
    bpy.ops.object.transform_apply(location=True)
    add_shape_key(cylinder, 1.6)
    bpy.ops.object.armature_add(location=(0, 0, 0))
    armature = bpy.context.object
    bpy.ops.object.mode_set(mode='EDIT')
    lower = armature.data.edit_bones[0]
    lower.name, lower.head, lower.tail = 'lower', (0, 0, 0), (0, 0, 2)
    upper = armature.data.edit_bones.new('upper')
    upper.head, upper.tail, upper.parent = (0, 0, 2), (0, 0, 4), lower
    bpy.ops.object.mode_set(mode='OBJECT')
    for name, share in (('lower', lambda z: 1 - z), ('upper', lambda z: z)):
        group = cylinder.vertex_groups.new(name=name)
        for vertex in cylinder.data.vertices:
            z = min(max((vertex.co.z - 1.2) / 1.6, 0), 1)
            group.add([vertex.index], share(z), 'REPLACE')
    cylinder.parent = armature
    cylinder.modifiers.new('Armature', 'ARMATURE').object = armature
    armature.location = (3, 1, 0)
    armature.scale = (1.5, 1.5, 1.5)
    armature.rotation_euler = (0.2, 0.3, 0.4)
    key_bone(armature.pose.bones['upper'], 1, 0.0)
    key_bone(armature.pose.bones['upper'], 13, 1.4)
    key_bone(armature.pose.bones['upper'], 25, -0.6)
    key_bone(armature.pose.bones['lower'], 1, 0.3)
    key_bone(armature.pose.bones['lower'], 25, -0.3)
    return cylinder


def add_shape_key(thing, factor):
    thing.shape_key_add(name='Basis')
    swollen = thing.shape_key_add(name='swollen')
    for i, point in enumerate(swollen.data):
        if i % 2 == 0:
            point.co = point.co * factor
    for frame, value in ((1, 0.0), (13, 1.0), (25, 0.25)):
        swollen.value = value
        swollen.keyframe_insert('value', frame=frame)


def add_turning_cube():
    bpy.ops.object.empty_add(location=(-3, 0, 1))
    parent = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(size=1, location=(1, 0, 0), rotation=(0.1, 0.2, 0.3))
    cube = bpy.context.object
    cube.parent = parent
    add_shape_key(cube, 2.0)
    for frame, angle in ((1, 0.0), (25, 4.0)):
        parent.rotation_euler = (angle / 3, 0, angle)
        parent.keyframe_insert('rotation_euler', frame=frame)
    return cube


def export(path, animated):
    bpy.ops.export_scene.gltf(filepath=path, export_format='GLB', use_selection=not animated,
                              export_animations=animated, export_force_sampling=True,
                              export_normals=True, export_materials='NONE')


# What a frame looks like, as meshes that know nothing of how they came about.
def bake(things, frame, path):
    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    baked = []
    for thing in things:
        evaluated = thing.evaluated_get(graph)
        mesh = bpy.data.meshes.new_from_object(evaluated, depsgraph=graph)
        copy = bpy.data.objects.new('baked', mesh)
        copy.matrix_world = evaluated.matrix_world
        bpy.context.collection.objects.link(copy)
        baked.append(copy)
    bpy.ops.object.select_all(action='DESELECT')
    for copy in baked:
        copy.select_set(True)
    export(path, False)
    for copy in baked:
        bpy.data.objects.remove(copy)


def main():
    folder = sys.argv[sys.argv.index('--') + 1]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 24, FRAMES[0], FRAMES[-1]
    things = [add_bent_cylinder(), add_turning_cube()]
    scene.frame_set(FRAMES[0])
    export(os.path.join(folder, 'animated.glb'), True)
    for frame in FRAMES:
        bake(things, frame, os.path.join(folder, 'baked_%d.glb' % frame))


main()
