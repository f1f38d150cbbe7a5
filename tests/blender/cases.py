"""The scenes of the round through Blender: one input of a material, one kind of light, one trait of
a camera or of a node each. A case builds its scene with sample_scenes/scene_kit.py; the stage, a
floor, a dome of dim light and a bright panel, is common to most."""

import math

import bpy
import mathutils
import scene_kit as kit

SIZE = (96, 72)


# ---- the stage -------------------------------------------------------------------------------


def add_world(strength):
    """Even light from everywhere. It is not in the file, so that round.py hands it on."""
    world = bpy.data.worlds.new("World")
    world.color = (strength,) * 3
    bpy.context.scene.world = world


def add_floor(material=None):
    return kit.add_quad("Floor", (-6.0, -6.0, 0.0), (12.0, 0.0, 0.0), (0.0, 12.0, 0.0),
                        material or kit.lambert("Floor", (0.5, 0.45, 0.4)))


def add_panel(strength=12.0):
    """A square of light above, to the left."""
    return kit.add_quad("Panel", (-2.6, -1.6, 3.6), (0.0, 1.4, 0.0), (1.2, 0.0, 0.5),
                        kit.emitter("Panel", (1.0, 0.95, 0.9), strength))


def add_view():
    return kit.add_camera((0.0, -5.2, 2.4), (0.0, 0.0, 0.75), 42.0)


def stage(world=0.35, panel=12.0):
    add_floor()
    if world > 0.0:
        add_world(world)
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
    """Principled: metal, roughness 0.6"""
    shown_on_ball(multiscatter(kit.metal("Metal", (0.9, 0.6, 0.3), 0.6)))


def smooth_metal():
    """Principled: metal, roughness 0.15"""
    shown_on_ball(multiscatter(kit.metal("Metal", (0.9, 0.6, 0.3), 0.15)))


def half_metal():
    """Principled: Metallic 0.5"""
    material = kit.principled("Half", (0.7, 0.3, 0.2), Metallic=0.5, Roughness=0.4)
    shown_on_ball(multiscatter(material))


def plastic():
    """Principled: Specular 0.5, roughness 0.3"""
    material = kit.principled("Plastic", (0.2, 0.4, 0.7), Roughness=0.3, Specular=0.5)
    shown_on_ball(multiscatter(material))


def matte():
    """Diffuse (what matte is everywhere below)"""
    shown_on_ball(kit.lambert("Matte", (0.2, 0.4, 0.7)))


def strong_specular():
    """Principled: Specular 1"""
    material = kit.principled("Specular", (0.2, 0.4, 0.7), Roughness=0.3, Specular=1.0)
    shown_on_ball(multiscatter(material))


def specular_alone():
    """Principled: specular over black"""
    material = kit.principled("Specular", (0.0, 0.0, 0.0), Roughness=0.3, Specular=0.5)
    shown_on_ball(multiscatter(material))


def no_specular():
    """Principled: Specular 0, as exported"""
    shown_on_ball(kit.principled("Dull", (0.2, 0.4, 0.7), Roughness=0.3, Specular=0.0))


def principled_diffuse():
    """Principled: its diffuse part, roughness 1"""
    material = kit.lambert("Matte", (0.2, 0.4, 0.7))
    material["keeps_nodes"] = True
    shown_on_ball(material)


def sheen():
    """Velvet BSDF beside a black Principled, sigma 0.5"""
    material = kit.lambert("Velvet", (0.0, 0.0, 0.0))
    material["keeps_nodes"] = True
    tree = material.node_tree
    velvet, both = (tree.nodes.new("ShaderNode" + kind) for kind in ("BsdfVelvet", "AddShader"))
    velvet.inputs["Color"].default_value = (0.8, 0.5, 0.6, 1.0)
    velvet.inputs["Sigma"].default_value = 0.5
    tree.links.new(tree.nodes["Principled BSDF"].outputs[0], both.inputs[0])
    tree.links.new(velvet.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    shown_on_ball(material)


def clear_glass():
    """Principled: Transmission 1, index 1.45"""
    shown_on_ball(kit.glass("Glass", 1.45))


def coloured_glass():
    """Principled: Transmission 1, coloured"""
    shown_on_ball(kit.glass("Glass", 1.3, (0.6, 0.9, 0.7)))


def rough_glass():
    """Principled: Transmission 1, roughness 0.35"""
    material = kit.principled("Rough", (1.0, 1.0, 1.0), Roughness=0.35, Transmission=1.0, IOR=1.45)
    shown_on_ball(multiscatter(material))


def filled_glass(color, density):
    """Glass with a Volume Absorption node and a thickness, by the exporter's group of nodes."""
    material = kit.glass("Glass", 1.45)
    tree = material.node_tree
    volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
    volume.inputs["Color"].default_value = (*color, 1.0)
    volume.inputs["Density"].default_value = density
    tree.links.new(volume.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    settings = bpy.data.node_groups.new("glTF Material Output", "ShaderNodeTree")
    settings.inputs.new("NodeSocketFloat", "Thickness")
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = settings
    node.inputs["Thickness"].default_value = 1.0
    return material


def filled_glass_pale():
    """Glass with Volume Absorption, pale"""
    shown_on_ball(filled_glass((0.92, 0.98, 0.95), 2.0))


def filled_glass_dark():
    """Glass with Volume Absorption, saturated"""
    shown_on_ball(filled_glass((0.2, 0.8, 0.5), 0.5))


def clearcoat():
    """Principled: clearcoat over a red base"""
    material = kit.principled("Coat", (0.6, 0.1, 0.1), Roughness=0.6, Specular=0.5, Clearcoat=1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Clearcoat Roughness"].default_value = 0.1
    shown_on_ball(multiscatter(material))


def coat_alone():
    """Principled: clearcoat over black"""
    material = kit.lambert("Coat", (0.0, 0.0, 0.0))
    material["keeps_nodes"] = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Clearcoat"].default_value = 1.0
    shader.inputs["Clearcoat Roughness"].default_value = 0.1
    shown_on_ball(material)


def emission():
    """Principled: emission"""
    material = kit.lambert("Glow", (0.0, 0.0, 0.0))
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission"].default_value = (1.0, 0.4, 0.1, 1.0)
    shader.inputs["Emission Strength"].default_value = 3.0
    shown_on_ball(material)


def unlit():
    """Unlit: a colour as surface"""
    material = kit.principled("Unlit", (0.0, 0.0, 0.0))
    tree = material.node_tree
    color = tree.nodes.new("ShaderNodeRGB")
    color.outputs[0].default_value = (0.9, 0.5, 0.1, 1.0)
    tree.links.new(color.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shown_on_ball(material)


def unlit_for_camera():
    """Unlit: emission for camera rays alone"""
    material = kit.principled("Unlit", (0.0, 0.0, 0.0))
    tree = material.node_tree
    mix, path, light = (tree.nodes.new(kind) for kind in (
        "ShaderNodeMixShader", "ShaderNodeLightPath", "ShaderNodeEmission"))
    light.inputs["Color"].default_value = (0.9, 0.5, 0.1, 1.0)
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
    tree.links.new(light.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shown_on_ball(material)


def alpha_blend():
    """Alpha 0.4, blend mode Alpha Blend"""
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


def painted(interpolation):
    """A material with the checker as colour, and its Image Texture node."""
    material = kit.lambert("Checker", (1.0, 1.0, 1.0))
    kit.use_texture(material, make_image("checker", checker))
    node = next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    node.interpolation = interpolation
    return material, node


def base_texture():
    """Image as base colour, interpolation Closest"""
    stage()
    add_board(painted("Closest")[0])


def smooth_texture():
    """Image as base colour, interpolation Linear"""
    stage()
    add_board(painted("Linear")[0])


def moved_texture():
    """Mapping node (KHR_texture_transform)"""
    material, image = painted("Closest")
    tree = material.node_tree
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Location"].default_value = (0.2, 0.35, 0.0)
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, 0.5)
    mapping.inputs["Scale"].default_value = (1.5, 0.75, 1.0)
    tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], image.inputs["Vector"])
    stage()
    add_board(material)


def emission_texture():
    """Image as emission"""
    material = kit.lambert("Screen", (0.0, 0.0, 0.0))
    material["keeps_nodes"] = True
    tree = material.node_tree
    image = tree.nodes.new("ShaderNodeTexImage")
    image.image = make_image("checker", checker)
    image.interpolation = "Closest"
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(image.outputs["Color"], shader.inputs["Emission"])
    shader.inputs["Emission Strength"].default_value = 2.0
    stage()
    add_board(material)


def two_uv_maps():
    """Two UV maps, two images"""
    material = multiscatter(kit.metal("Metal", (1.0, 1.0, 1.0), 0.4))
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    images = (make_image("checker", checker),
              make_image("rough", lambda x, y: (0.0, 0.2 + 0.6 * (int(x * 3) % 2), 1.0, 1.0),
                         is_data=True))
    sockets = []
    for name, image in zip(("First", "Second"), images):
        coordinates, node = tree.nodes.new("ShaderNodeUVMap"), tree.nodes.new("ShaderNodeTexImage")
        coordinates.uv_map, node.image, node.interpolation = name, image, "Closest"
        tree.links.new(coordinates.outputs["UV"], node.inputs["Vector"])
        sockets.append(node.outputs["Color"])
    split = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(sockets[0], shader.inputs["Base Color"])
    tree.links.new(sockets[1], split.inputs["Color"])
    tree.links.new(split.outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(split.outputs["Blue"], shader.inputs["Metallic"])
    stage()
    mesh = add_board(material).data
    mesh.uv_layers[0].name = "First"
    second = mesh.uv_layers.new(name="Second")
    for loop, uv in zip(second.data, ((0.1, 0.9), (0.1, 0.1), (0.9, 0.1), (0.9, 0.9))):
        loop.uv = uv


def normal_texture():
    """Normal map"""
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
    """Image as roughness and metallic"""
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
    """Image with alpha, blend mode Alpha Clip"""
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


def alpha_image():
    """Image with alpha, blend mode Alpha Blend"""
    material = kit.lambert("Veil", (1.0, 1.0, 1.0))
    kit.use_texture(material, make_image("veil", lambda x, y: (0.7, 0.5, 0.2, x), size=256))
    tree = material.node_tree
    image = next(node for node in tree.nodes if node.type == "TEX_IMAGE")
    tree.links.new(image.outputs["Alpha"], tree.nodes["Principled BSDF"].inputs["Alpha"])
    material.blend_method = "BLEND"
    material["alpha_from"] = image.name
    stage()
    add_board(material)


def vertex_colours():
    """Vertex colours"""
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
    stage(world=0.0, panel=0.0)
    ball(kit.lambert("Matte", (0.7, 0.7, 0.7)))
    data = bpy.data.lights.new("Lamp", kind)
    data.energy = energy
    data.color = (1.0, 0.8, 0.6)
    for key, value in traits.items():
        setattr(data, key, value)
    lamp = kit.link("Lamp", data, location)
    kit.aim(lamp, target)


def point_light():
    """Point lamp"""
    lit_by("POINT", 400.0, (-2.0, -2.0, 3.5), shadow_soft_size=0.0)


def round_point_light():
    """Point lamp with a radius (extras)"""
    lit_by("POINT", 400.0, (-2.0, -2.0, 3.5), shadow_soft_size=0.4)


def hard_spot():
    """Spot, blend 0 (extras)"""
    lit_by("SPOT", 600.0, (-2.0, -2.0, 4.0), (0.0, 0.0, 0.5), shadow_soft_size=0.0,
           spot_size=math.radians(45.0), spot_blend=0.0)


def soft_spot():
    """Spot, blend 0.6 (extras)"""
    lit_by("SPOT", 600.0, (-2.0, -2.0, 4.0), (0.0, 0.0, 0.5), shadow_soft_size=0.0,
           spot_size=math.radians(60.0), spot_blend=0.6)


def round_spot():
    """Spot with a radius (extras)"""
    lit_by("SPOT", 600.0, (-2.0, -2.0, 4.0), (0.0, 0.0, 0.5), shadow_soft_size=0.3,
           spot_size=math.radians(60.0), spot_blend=0.0)


def sun():
    """Sun"""
    lit_by("SUN", 3.0, (-2.0, -2.0, 4.0), angle=0.0)


def wide_sun():
    """Sun, angle 20° (extras)"""
    lit_by("SUN", 3.0, (-2.0, -2.0, 4.0), angle=math.radians(20.0))


def square_area():
    """Area lamp: square (extras)"""
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="SQUARE", size=1.5)


def oblong_area():
    """Area lamp: rectangle (extras)"""
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="RECTANGLE", size=2.0,
           size_y=0.5)


def round_area():
    """Area lamp: disk (extras)"""
    lit_by("AREA", 200.0, (-2.0, -2.0, 3.5), (0.0, 0.0, 0.5), shape="DISK", size=1.5)


# ---- cameras and nodes -----------------------------------------------------------------------


def seen_by(**traits):
    stage()
    ball(kit.lambert("Matte", (0.2, 0.4, 0.7)))
    camera = bpy.context.scene.camera.data
    for key, value in traits.items():
        setattr(camera, key, value)


def horizontal_fit():
    """Camera: sensor fit Horizontal"""
    seen_by(sensor_fit="HORIZONTAL", lens=40.0)


def vertical_fit():
    """Camera: sensor fit Vertical"""
    seen_by(sensor_fit="VERTICAL", sensor_height=24.0, lens=40.0)


def shifted_view():
    """Camera: shift (extras)"""
    seen_by(shift_x=0.15, shift_y=-0.1)


def shifted_tall():
    """Camera: shift, sensor fit Vertical (extras)"""
    seen_by(shift_x=-0.2, shift_y=0.1, sensor_fit="VERTICAL", sensor_height=24.0, lens=30.0)


def shifted_orthographic():
    """Camera: orthographic, shift (extras)"""
    seen_by(type="ORTHO", ortho_scale=4.5, shift_x=0.2, shift_y=0.1)


def orthographic():
    """Camera: orthographic"""
    seen_by(type="ORTHO", ortho_scale=4.5)


def upright_picture():
    """Camera: upright picture, sensor fit Auto"""
    bpy.context.scene.render.resolution_x = SIZE[1]
    bpy.context.scene.render.resolution_y = SIZE[0]
    seen_by()


def nested_nodes():
    """Parented, mirrored, unevenly scaled"""
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
    """Objects that share a mesh"""
    stage()
    first = kit.add_sphere("One", (-1.3, 0.0, 0.5), 0.5, kit.lambert("Matte", (0.2, 0.5, 0.3)))
    for i in (1, 2):
        other = kit.link(f"Copy {i}", first.data, (-1.3 + 1.3 * i, 0.0, 0.5))
        other.scale = (0.6 + 0.2 * i,) * 3


def collection_instances():
    """Collection instances"""
    stage()
    group = bpy.data.collections.new("Group")
    matte = kit.lambert("Matte", (0.2, 0.5, 0.3))
    for part in (kit.add_cuboid("Foot", (-0.4, -0.4, 0.0), (0.4, 0.4, 0.4), matte),
                 kit.add_sphere("Head", (0.0, 0.0, 0.7), 0.3, matte)):
        bpy.context.scene.collection.objects.unlink(part)
        group.objects.link(part)
    for i in range(2):
        copy = kit.link(f"Copy {i}", None, (-0.9 + 1.8 * i, 0.2, 0.0))
        copy.instance_type, copy.instance_collection = "COLLECTION", group
        copy.rotation_euler = (0.0, 0.0, 0.6 * i)
        copy.scale = (1.0, 1.0, 1.0 + 0.5 * i)


# ---- animation: pictures at frame 10 ---------------------------------------------------------


def moving_object():
    """Moving and turning object"""
    stage()
    thing = kit.add_cuboid("Box", (-0.5, -0.5, 0.2), (0.5, 0.5, 1.2),
                           kit.lambert("Matte", (0.2, 0.5, 0.3)))
    for frame, x, turn in ((1, -1.5, 0.0), (20, 1.5, 1.2)):
        thing.location.x = x
        thing.rotation_euler = (0.0, 0.0, turn)
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_euler", frame=frame)


def spinning_object():
    """Turning fast"""
    stage()
    thing = kit.add_cuboid("Bar", (-1.2, -0.3, 0.6), (1.2, 0.3, 1.2),
                           kit.lambert("Matte", (0.2, 0.5, 0.3)))
    for frame, turn in ((1, 0.0), (20, 14.0)):
        thing.rotation_euler = (0.0, turn, 0.0)
        thing.keyframe_insert("rotation_euler", frame=frame)


def moving_camera():
    """Camera moved and turned"""
    stage()
    kit.add_cuboid("Box", (-0.5, -0.5, 0.2), (0.5, 0.5, 1.2), kit.lambert("Matte", (0.2, 0.5, 0.3)))
    camera = bpy.context.scene.camera
    for frame, place in ((1, (-2.0, -5.0, 1.5)), (20, (1.5, -4.0, 3.5))):
        camera.location = place
        kit.aim(camera, (0.0, 0.0, 0.75))
        camera.keyframe_insert("location", frame=frame)
        camera.keyframe_insert("rotation_euler", frame=frame)


def shape_keys():
    """Shape keys"""
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
    """Armature"""
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
    """build makes the scene, its docstring is what the table in docs/blender.md calls it; limit is
    the largest difference of a block that passes, as a share of its brightness; why says what is
    known to differ; frame is the moment, blur the shutter in frames; samples are for a pixel."""

    def __init__(self, build, limit=0.05, why="", frame=None, blur=None, samples=None,
                 is_quick=False):
        self.name = build.__name__ + ("_blurred" if blur else "")
        self.what = build.__doc__ + (", blurred" if blur else "")
        self.build, self.limit, self.why, self.frame, self.blur = build, limit, why, frame, blur
        self.samples, self.is_quick = samples, is_quick


LAYERS = ("Cycles adds the reflection to the diffuse part, which is Disney's; here a Lambertian "
          "part gets what the reflection leaves")
COAT = "Cycles 3.4 has a quarter of the coat, and a wider lobe (GTR1)"
NORMALS = "normals are blended between shapes; Blender computes them from the shape that results"

CASES = [
    Case(matte),
    Case(rough_metal, is_quick=True),
    Case(smooth_metal),
    Case(half_metal, 0.14, LAYERS),
    Case(specular_alone, 0.22, "Schlick's Fresnel term, as glTF has it; Cycles has the exact one "
         "(in uniform light, 53° to 64° off the normal: 0.074 and 0.092)"),
    Case(plastic, 0.17, LAYERS),
    Case(strong_specular, 0.22, LAYERS),
    Case(no_specular, 0.14, "the exporter writes a black specular colour, which by glTF still "
         "mirrors at grazing angles; and the diffuse part of the next row"),
    Case(principled_diffuse, 0.2, "Cycles 3.4 has Disney's, brighter than Lambert's at grazing "
         "angles"),
    Case(sheen, 0.9, "the exporter takes Velvet for sheen; these are two different lobes"),
    Case(clear_glass, samples=256),
    Case(coloured_glass, samples=256),
    Case(rough_glass, 0.3, "Cycles walks from facet to facet and spreads light wider: of a cone of "
         "32° straight behind the ball its middle shows 0.87, here 0.91. In even light both return "
         "all", samples=256),
    Case(filled_glass_pale, samples=256),
    Case(filled_glass_dark, 0.5, "Cycles absorbs (1 - colour) × density, the exporter writes what "
         "means -ln(colour) × density", samples=128),
    Case(coat_alone, 2.5, COAT),
    Case(clearcoat, 0.3, COAT),
    Case(emission, is_quick=True),
    Case(unlit),
    Case(unlit_for_camera, 2.6, "here what is unlit shines on what is near"),
    Case(alpha_blend),
    Case(base_texture),
    Case(smooth_texture, 0.17, "64 pixels wide: Cycles blends sRGB values, which is darker at "
         "edges; here light is blended, as glTF asks for"),
    Case(moved_texture, is_quick=True),
    Case(two_uv_maps),
    Case(emission_texture),
    Case(normal_texture, 0.15, "35° steep: Cycles darkens where light grazes the true surface; "
         "at 12° the largest difference is 3 %"),
    Case(roughness_texture),
    Case(cut_out, is_quick=True),
    Case(alpha_image),
    Case(vertex_colours),
    Case(point_light),
    Case(round_point_light, why="Cycles 3.4 has a disk that faces each point, not a ball"),
    Case(hard_spot, samples=256),
    Case(soft_spot),
    Case(round_spot),
    Case(sun),
    Case(wide_sun, why="Cycles weighs the disk by the cosine from its middle", is_quick=True),
    Case(square_area),
    Case(oblong_area),
    Case(round_area, is_quick=True),
    Case(horizontal_fit),
    Case(vertical_fit),
    Case(shifted_view), Case(shifted_tall), Case(shifted_orthographic),
    Case(orthographic),
    Case(upright_picture),
    Case(nested_nodes, is_quick=True),
    Case(instances),
    Case(collection_instances),
    Case(moving_object, frame=10),
    Case(shape_keys, 0.09, NORMALS, frame=10),
    Case(armature, 0.08, NORMALS, frame=10),
    Case(moving_camera, frame=10),
    Case(moving_object, frame=10, blur=0.5),
    Case(spinning_object, frame=10, blur=0.5),
    Case(shape_keys, 0.09, NORMALS, frame=10, blur=0.5),
    Case(moving_camera, frame=10, blur=0.5, is_quick=True),
]
