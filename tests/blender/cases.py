"""The scenes of the round through Blender: one input of a material, one kind of light, one trait of
a camera or of a node each. A case builds its scene with sample_scenes/scene_kit.py; the stage, a
floor, a dome of dim light and a bright panel, is common to most."""

import math

import bpy
import mathutils
import scene_kit as kit

SIZE = (96, 72)


# ---- the stage -------------------------------------------------------------------------------


def add_dome(strength):
    """A ball of light around everything, seen from inside."""
    profile = [(20.0 * math.cos(a), 20.0 * math.sin(a)) for a in half_circle(24)]
    return kit.add_lathe("Dome", profile, kit.emitter("Dome", (1.0, 1.0, 1.0), strength),
                         segments=48)


def half_circle(steps):
    """Angles from the upper to the lower pole: a lathe of them faces inwards."""
    return [math.pi * (0.5 - i / steps) for i in range(steps + 1)]


def add_floor(material=None):
    return kit.add_quad("Floor", (-6.0, -6.0, 0.0), (12.0, 0.0, 0.0), (0.0, 12.0, 0.0),
                        material or kit.lambert("Floor", (0.5, 0.45, 0.4)))


def add_panel(strength=12.0):
    """A square of light above, to the left."""
    return kit.add_quad("Panel", (-2.6, -1.6, 3.6), (0.0, 1.4, 0.0), (1.2, 0.0, 0.5),
                        kit.emitter("Panel", (1.0, 0.95, 0.9), strength))


def add_view():
    return kit.add_camera((0.0, -5.2, 2.4), (0.0, 0.0, 0.75), 42.0)


def stage(dome=0.35, panel=12.0):
    add_floor()
    if dome > 0.0:
        add_dome(dome)
    if panel > 0.0:
        add_panel(panel)
    add_view()


def ball(material):
    return kit.add_sphere("Ball", (0.0, 0.0, 1.0), 1.0, material)


def shown_on_ball(material):
    stage()
    ball(material)


# ---- materials -------------------------------------------------------------------------------


def multiscatter(material):
    """Cycles' GGX that loses no energy, as ours does not."""
    material.node_tree.nodes["Principled BSDF"].distribution = "MULTI_GGX"
    return material


def rough_metal():
    shown_on_ball(multiscatter(kit.metal("Metal", (0.9, 0.6, 0.3), 0.6)))


def smooth_metal():
    shown_on_ball(multiscatter(kit.metal("Metal", (0.9, 0.6, 0.3), 0.15)))


def half_metal():
    material = kit.principled("Half", (0.7, 0.3, 0.2), Metallic=0.5, Roughness=0.4)
    shown_on_ball(multiscatter(material))


def plastic():
    material = kit.principled("Plastic", (0.2, 0.4, 0.7), Roughness=0.3, Specular=0.5)
    shown_on_ball(multiscatter(material))


def matte():
    shown_on_ball(kit.lambert("Matte", (0.2, 0.4, 0.7)))


def strong_specular():
    material = kit.principled("Specular", (0.2, 0.4, 0.7), Roughness=0.3, Specular=1.0)
    shown_on_ball(multiscatter(material))


def clear_glass():
    shown_on_ball(kit.glass("Glass", 1.45))


def coloured_glass():
    shown_on_ball(kit.glass("Glass", 1.3, (0.6, 0.9, 0.7)))


def rough_glass():
    material = kit.principled("Rough", (1.0, 1.0, 1.0), Roughness=0.35, Transmission=1.0, IOR=1.45)
    shown_on_ball(multiscatter(material))


def clearcoat():
    material = kit.principled("Coat", (0.6, 0.1, 0.1), Roughness=0.6, Specular=0.5, Clearcoat=1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Clearcoat Roughness"].default_value = 0.1
    shown_on_ball(multiscatter(material))


def emission():
    material = kit.lambert("Glow", (0.0, 0.0, 0.0))
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission"].default_value = (1.0, 0.4, 0.1, 1.0)
    shader.inputs["Emission Strength"].default_value = 3.0
    shown_on_ball(material)


def alpha_blend():
    material = kit.lambert("Veil", (0.8, 0.2, 0.2))
    material.node_tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.4
    material.blend_method = "BLEND"
    material["alpha"] = 0.4
    shown_on_ball(material)


# ---- textures --------------------------------------------------------------------------------


def make_image(name, pixel, is_data=False, size=64):
    """An image of pixel(x, y) -> (r, g, b, a), x and y in 0..1 from the lower left corner."""
    image = bpy.data.images.new(name, size, size, alpha=True, is_data=is_data)
    values = []
    for row in range(size):
        for column in range(size):
            values += pixel((column + 0.5) / size, (row + 0.5) / size)
    image.pixels.foreach_set(values)
    image.pack()
    return image


def checker(x, y):
    is_light = (int(x * 8) + int(y * 8)) % 2 == 0
    return (0.85, 0.75, 0.3, 1.0) if is_light else (0.1, 0.2 + 0.5 * x, 0.5, 1.0)


def add_board(material, uvs=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))):
    """An upright board in the place of the ball."""
    return kit.add_quad("Board", (-1.2, 0.0, 0.1), (2.4, 0.0, 0.0), (0.0, 0.8, 1.8), material,
                        uvs=uvs)


def base_texture():
    material = kit.lambert("Checker", (1.0, 1.0, 1.0))
    kit.use_texture(material, make_image("checker", checker))
    stage()
    add_board(material)


def moved_texture():
    """A Mapping node: KHR_texture_transform."""
    material = kit.lambert("Checker", (1.0, 1.0, 1.0))
    kit.use_texture(material, make_image("checker", checker))
    tree = material.node_tree
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Location"].default_value = (0.2, 0.35, 0.0)
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.5)
    mapping.inputs["Scale"].default_value = (1.5, 0.75, 1.0)
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    image = next(node for node in tree.nodes if node.type == "TEX_IMAGE")
    tree.links.new(mapping.outputs["Vector"], image.inputs["Vector"])
    stage()
    add_board(material)


def normal_texture():
    def bumps(x, y):
        slope_x = 0.5 * math.sin(6.0 * math.pi * x)
        slope_y = 0.5 * math.sin(4.0 * math.pi * y)
        length = math.sqrt(1.0 + slope_x**2 + slope_y**2)
        return (0.5 - 0.5 * slope_x / length, 0.5 - 0.5 * slope_y / length,
                0.5 + 0.5 / length, 1.0)

    material = kit.lambert("Bumps", (0.7, 0.7, 0.7))
    tree = material.node_tree
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = make_image("bumps", bumps, is_data=True, size=256)
    node = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(image.outputs["Color"], node.inputs["Color"])
    tree.links.new(node.outputs["Normal"], tree.nodes["Principled BSDF"].inputs["Normal"])
    stage()
    add_board(material)


def roughness_texture():
    """Green is roughness and blue is metallic, as glTF packs them."""
    material = multiscatter(kit.principled("Packed", (0.9, 0.7, 0.5)))
    tree = material.node_tree
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = make_image("packed", lambda x, y: (0.0, 0.15 + 0.7 * x, 1.0, 1.0), is_data=True)
    split = tree.nodes.new("ShaderNodeSeparateColor")
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(image.outputs["Color"], split.inputs["Color"])
    tree.links.new(split.outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(split.outputs["Blue"], shader.inputs["Metallic"])
    stage()
    add_board(material)


def cut_out():
    """Alpha by a texture, clipped."""
    def holes(x, y):
        is_hole = (x * 4 % 1.0 - 0.5) ** 2 + (y * 4 % 1.0 - 0.5) ** 2 < 0.1
        return (0.7, 0.5, 0.2, 0.0 if is_hole else 1.0)

    material = kit.lambert("Holes", (1.0, 1.0, 1.0))
    kit.use_texture(material, make_image("holes", holes, size=256))
    tree = material.node_tree
    image = next(node for node in tree.nodes if node.type == "TEX_IMAGE")
    tree.links.new(image.outputs["Alpha"], tree.nodes["Principled BSDF"].inputs["Alpha"])
    material.blend_method = "CLIP"
    material["alpha_from"] = image.name
    stage()
    add_board(material)


def vertex_colours():
    material = kit.lambert("Painted", (1.0, 1.0, 1.0))
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "Col"
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    stage()
    thing = ball(material)
    layer = thing.data.color_attributes.new("Col", "FLOAT_COLOR", "POINT")
    for vertex, value in zip(thing.data.vertices, layer.data):
        height = 0.5 + 0.5 * vertex.co.z
        value.color = (height, 0.3, 1.0 - height, 1.0)


# ---- lights ----------------------------------------------------------------------------------


def lit_by(kind, energy, location, target=(0.0, 0.0, 0.0), **traits):
    """A matte ball on a matte floor in one lamp's light alone."""
    stage(dome=0.0, panel=0.0)
    ball(kit.lambert("Matte", (0.7, 0.7, 0.7)))
    data = bpy.data.lights.new("Lamp", kind)
    data.energy = energy
    data.color = (1.0, 0.8, 0.6)
    for key, value in traits.items():
        setattr(data, key, value)
    lamp = kit.link("Lamp", data, location)
    kit.aim(lamp, target)


def point_light():
    lit_by("POINT", 400.0, (-2.0, -2.0, 3.5), shadow_soft_size=0.0)


def round_point_light():
    lit_by("POINT", 400.0, (-2.0, -2.0, 3.5), shadow_soft_size=0.4)


def hard_spot():
    lit_by("SPOT", 600.0, (-2.0, -2.0, 4.0), (0.0, 0.0, 0.5), shadow_soft_size=0.0,
           spot_size=math.radians(45.0), spot_blend=0.0)


def soft_spot():
    lit_by("SPOT", 600.0, (-2.0, -2.0, 4.0), (0.0, 0.0, 0.5), shadow_soft_size=0.0,
           spot_size=math.radians(60.0), spot_blend=0.6)


def sun():
    lit_by("SUN", 3.0, (-2.0, -2.0, 4.0), angle=0.0)


def wide_sun():
    lit_by("SUN", 3.0, (-2.0, -2.0, 4.0), angle=math.radians(20.0))


def square_area():
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="SQUARE", size=1.5)


def oblong_area():
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="RECTANGLE", size=2.0,
           size_y=0.5)


def round_area():
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="DISK", size=1.5)


# ---- cameras and nodes -----------------------------------------------------------------------


def seen_by(**traits):
    stage()
    ball(kit.lambert("Matte", (0.2, 0.4, 0.7)))
    camera = bpy.context.scene.camera.data
    for key, value in traits.items():
        setattr(camera, key, value)


def horizontal_fit():
    seen_by(sensor_fit="HORIZONTAL", lens=40.0)


def vertical_fit():
    seen_by(sensor_fit="VERTICAL", sensor_height=24.0, lens=40.0)


def shifted_view():
    seen_by(shift_x=0.15, shift_y=-0.1)


def orthographic():
    seen_by(type="ORTHO", ortho_scale=4.5)


def upright_picture():
    """Higher than wide, with the sensor's automatic fit."""
    bpy.context.scene.render.resolution_x = SIZE[1]
    bpy.context.scene.render.resolution_y = SIZE[0]
    seen_by()


def nested_nodes():
    """A mirrored, unevenly scaled box in a turned and scaled parent."""
    stage()
    parent = kit.link("Parent", None, (0.3, 0.0, 0.8))
    parent.rotation_euler = (0.3, 0.4, 0.8)
    parent.scale = (0.8, 1.2, 0.7)
    shape = [(-0.9, -0.4), (0.9, -0.4), (0.9, 0.2), (0.2, 0.6), (-0.9, 0.4)]
    child = kit.add_column("Child", shape, -0.5, 0.7, kit.lambert("Matte", (0.7, 0.3, 0.2)))
    child.parent = parent
    child.location = (0.1, 0.2, 0.1)
    child.rotation_euler = (0.0, 0.5, 0.0)
    child.scale = (-1.0, 0.8, 1.1)


def instances():
    """Objects that share a mesh."""
    stage()
    first = kit.add_sphere("One", (-1.3, 0.0, 0.5), 0.5, kit.lambert("Matte", (0.2, 0.5, 0.3)))
    for i in (1, 2):
        other = kit.link(f"Copy {i}", first.data, (-1.3 + 1.3 * i, 0.0, 0.5))
        other.scale = (0.6 + 0.2 * i,) * 3


# ---- animation: pictures at frame 10 ---------------------------------------------------------


def moving_object():
    stage()
    thing = kit.add_cuboid("Box", (-0.5, -0.5, 0.2), (0.5, 0.5, 1.2),
                           kit.lambert("Matte", (0.2, 0.5, 0.3)))
    for frame, x, turn in ((1, -1.5, 0.0), (20, 1.5, 1.2)):
        thing.location.x = x
        thing.rotation_euler = (0.0, 0.0, turn)
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_euler", frame=frame)


def shape_keys():
    stage()
    thing = ball(kit.lambert("Matte", (0.2, 0.5, 0.3)))
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Flat")
    for point in key.data:
        point.co.z *= 0.3
        point.co.x *= 1.4
    for frame, value in ((1, 0.0), (20, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)


def armature():
    stage()
    profile = [(0.0, 0.1)] + [(0.4, 0.1 + 0.1 * i) for i in range(19)] + [(0.0, 1.9)]
    thing = kit.add_lathe("Post", profile[::1], kit.lambert("Matte", (0.6, 0.4, 0.2)), segments=24)
    data = bpy.data.armatures.new("Bones")
    rig = kit.link("Rig", data)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    lower = data.edit_bones.new("Lower")
    lower.head, lower.tail = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    upper = data.edit_bones.new("Upper")
    upper.head, upper.tail = (0.0, 0.0, 1.0), (0.0, 0.0, 2.0)
    upper.parent = lower
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.parent = rig
    thing.modifiers.new("Rig", "ARMATURE").object = rig
    groups = [thing.vertex_groups.new(name=name) for name in ("Lower", "Upper")]
    for vertex in thing.data.vertices:
        share = min(max(vertex.co.z - 0.5, 0.0), 1.0)
        groups[0].add([vertex.index], 1.0 - share, "REPLACE")
        groups[1].add([vertex.index], share, "REPLACE")
    bone = rig.pose.bones["Upper"]
    bone.rotation_mode = "QUATERNION"
    for frame, angle in ((1, 0.0), (20, 1.2)):
        bone.rotation_quaternion = mathutils.Quaternion((0.0, 0.0, 1.0), angle)
        bone.keyframe_insert("rotation_quaternion", frame=frame)


class Case:
    """build makes the scene; limit is the largest difference of a block that passes, as a share of
    the picture's mean; why says what is known to differ, for the table in docs/blender.md."""

    def __init__(self, build, limit=0.05, why="", frame=None, blur=None):
        self.name = build.__name__
        self.build, self.limit, self.why, self.frame, self.blur = build, limit, why, frame, blur


CASES = [
    Case(matte), Case(rough_metal), Case(smooth_metal), Case(half_metal), Case(plastic),
    Case(strong_specular), Case(clear_glass), Case(coloured_glass), Case(rough_glass),
    Case(clearcoat), Case(emission), Case(alpha_blend),
    Case(base_texture), Case(moved_texture), Case(normal_texture), Case(roughness_texture),
    Case(cut_out), Case(vertex_colours),
    Case(point_light), Case(round_point_light), Case(hard_spot), Case(soft_spot), Case(sun),
    Case(wide_sun), Case(square_area), Case(oblong_area), Case(round_area),
    Case(horizontal_fit), Case(vertical_fit), Case(shifted_view), Case(orthographic),
    Case(upright_picture), Case(nested_nodes), Case(instances),
    Case(moving_object, frame=10), Case(shape_keys, frame=10), Case(armature, frame=10),
    Case(moving_object, frame=10, blur=0.5),
]
