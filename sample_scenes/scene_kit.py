"""What the sample scenes share: meshes, materials, glTF export and a Cycles reference.

Runs inside Blender 3.4:

    blender --background --factory-startup --threads 1 --python SCENE.py

Blender has +Z up and metres; its exporter turns the scene to glTF's +Y up. Meshes are made from
explicit vertex lists, and with one thread Blender sums the vertex normals in one order, so that
a scene comes out the same, byte for byte, each time.
"""

import json
import math
import os
import struct
import sys

import bpy
import mathutils


# ---- scene and objects ---------------------------------------------------------------------


def new_scene(width, height):
    """Empties Blender and sets the picture size, which gives the camera's aspect and yfov."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x = width
    scene.render.resolution_y = height
    scene.render.resolution_percentage = 100
    return scene


def link(name, data, location=(0.0, 0.0, 0.0)):
    """An object for data in the current scene."""
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_mesh(name, vertices, faces, material, location=(0.0, 0.0, 0.0), smooth=True, uvs=None):
    """A mesh object; uvs has one (u, v) per vertex, v up as in Blender."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    if uvs:
        layer = mesh.uv_layers.new(name="UVMap")
        for loop in mesh.loops:
            layer.data[loop.index].uv = uvs[loop.vertex_index]
    mesh.materials.append(material)
    mesh.validate()
    mesh.update()
    return link(name, mesh, location)


def add_quad(name, corner, edge_u, edge_v, material, uvs=None):
    """A flat parallelogram that faces along edge_u x edge_v."""
    corner, edge_u, edge_v = map(mathutils.Vector, (corner, edge_u, edge_v))
    corners = [corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v]
    return add_mesh(name, corners, [(0, 1, 2, 3)], material, smooth=False, uvs=uvs)


def add_sphere(name, location, radius, material, segments=80, rings=40):
    """A smooth latitude-longitude sphere."""
    profile = []
    for ring in range(rings + 1):
        angle = math.pi * (ring / rings - 0.5)
        profile.append((radius * math.cos(angle), radius * math.sin(angle)))
    return add_lathe(name, profile, material, location, segments)


def add_lathe(name, profile, material, location=(0.0, 0.0, 0.0), segments=128, closed=False):
    """Turns a profile of (radius, height) points about the vertical axis.

    The outside is on the right hand of the profile's direction, radius to the right and height
    up. First and last point of an open profile must lie on the axis; a closed one is a loop.
    """
    on_axis = [not closed and i in (0, len(profile) - 1) for i in range(len(profile))]
    vertices, rows = [], []
    for (radius, height), pole in zip(profile, on_axis):
        count = 1 if pole else segments
        first = len(vertices)
        rows.append([first + (k % count) for k in range(segments + 1)])
        for k in range(count):
            turn = 2.0 * math.pi * k / segments
            place = 0.0 if pole else radius
            vertices.append((place * math.cos(turn), place * math.sin(turn), height))
    faces = []
    for lower, upper in zip(rows, rows[1:] + rows[:1] if closed else rows[1:]):
        for k in range(segments):
            corners = (lower[k], lower[k + 1], upper[k + 1], upper[k])
            faces.append(tuple(dict.fromkeys(corners)))  # a pole gives a triangle
    return add_mesh(name, vertices, faces, material, location)


def arc(center, radius, start, end, steps):
    """Points of (radius, height) on a circle; angles in degrees, 90 is up."""
    turns = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return [
        (center[0] + radius * math.cos(turn), center[1] + radius * math.sin(turn))
        for turn in turns
    ]


def line(start, end, steps):
    """Points between start and end, without them: they keep the normals of long walls straight."""
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    return [(x + dx * i / steps, y + dy * i / steps) for i in range(1, steps)]


def shell(outside, thickness):
    """A closed profile from the outer one of an open vessel: over the rim and down inside.

    outside runs from the foot's middle up to the lip; the inner side is offset from it.
    """
    points = [mathutils.Vector(point) for point in outside]
    inside = []
    for i, point in enumerate(points):
        along = (points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]).normalized()
        inner = point + thickness * mathutils.Vector((-along.y, along.x))
        if inner.x > thickness:
            inside.append(tuple(inner))
    lip = (points[-1] + mathutils.Vector(inside[-1])) / 2
    lip += 0.5 * thickness * (points[-1] - points[-2]).normalized()
    return [*outside, tuple(lip), *reversed(inside), (0.0, inside[0][1])]


def smooth_profile(knots, steps=4):
    """A Catmull-Rom curve through points of (radius, height)."""
    points = [mathutils.Vector(knot) for knot in knots]
    points = [2 * points[0] - points[1], *points, 2 * points[-1] - points[-2]]
    curve = []
    for a, b, c, d in zip(points, points[1:], points[2:], points[3:]):
        for i in range(steps):
            t = i / steps
            curve.append(
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2)
                + 0.5 * (3 * b - a - 3 * c + d) * t**3
            )
    curve.append(points[-2])
    return [(max(point.x, 0.0), point.y) for point in curve]


def add_cuboid(name, low, high, material, turn_degrees=0.0):
    """A box between two corners, turned about the vertical through its middle."""
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    x, y, z = ((b - a) / 2 for a, b in zip(low, high))
    polygon = [(-x, -y), (x, -y), (x, y), (-x, y)]
    box = add_column(name, polygon, -z, z, material, middle)
    box.rotation_euler.z = math.radians(turn_degrees)
    return box


def add_column(name, polygon, bottom, top, material, location=(0.0, 0.0, 0.0)):
    """A polygon (x, y), counter-clockwise seen from above, drawn out along z; flat faces."""
    count = len(polygon)
    vertices = [(x, y, z) for z in (bottom, top) for x, y in polygon]
    faces = [tuple(reversed(range(count))), tuple(range(count, 2 * count))]
    for i in range(count):
        j = (i + 1) % count
        faces.append((i, j, j + count, i + count))
    return add_mesh(name, vertices, faces, material, location, smooth=False)


def add_tube(name, points, radius, material, segments=24):
    """A round bar along points, with flat ends that are its own faces; no sharp bends."""
    points = [mathutils.Vector(point) for point in points]
    vertices, side = [], None
    for i, point in enumerate(points):
        along = (points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]).normalized()
        guess = side or along.orthogonal()  # carried along, so that the bar is not twisted
        side = (guess - along * guess.dot(along)).normalized()
        other = along.cross(side)
        for k in range(segments):
            turn = 2.0 * math.pi * k / segments
            vertices.append(point + radius * (math.cos(turn) * side + math.sin(turn) * other))
    faces = []
    for row in range(0, (len(points) - 1) * segments, segments):
        for k in range(segments):
            j = (k + 1) % segments
            faces.append((row + k, row + j, row + segments + j, row + segments + k))
    ends = (range(segments - 1, -1, -1), range(len(vertices) - segments, len(vertices)))
    for ring in map(list, ends):
        first = len(vertices)
        vertices += [vertices[k].copy() for k in ring]
        faces.append(tuple(range(first, first + segments)))
    return add_mesh(name, vertices, faces, material)


def add_spot(name, location, target, watts, angle_degrees, blend, color=(1.0, 1.0, 1.0)):
    """A spot lamp; watts / 4 pi is its intensity as the renderer counts, angle the full cone.

    Cycles' lamp is a ball of 4 mm radius, a glTF spot is a point.
    """
    data = bpy.data.lights.new(name, "SPOT")
    data.energy = watts
    data.color = color
    data.spot_size = math.radians(angle_degrees)
    data.spot_blend = blend
    data.shadow_soft_size = 0.004
    spot = link(name, data, location)
    aim(spot, target)
    return spot


def turn_about_z(thing, frames):
    """One even turn from frame 0 to frame number frames."""
    for frame, angle in ((0, 0.0), (frames, 2.0 * math.pi)):
        thing.rotation_euler.z = angle
        thing.keyframe_insert("rotation_euler", index=2, frame=frame)
    for point in thing.animation_data.action.fcurves[0].keyframe_points:
        point.interpolation = "LINEAR"
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 0, frames
    scene.frame_set(0)


def add_camera(location, target, fov_degrees):
    """The camera, named "Camera"; fov is the angle of the picture's longer side."""
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit = "AUTO"
    data.angle = math.radians(fov_degrees)
    data.clip_start = 0.01
    camera = link("Camera", data, location)
    aim(camera, target)
    bpy.context.scene.camera = camera
    return camera


def aim(thing, target):
    """Turns a camera or lamp so that its -Z axis points at target, +Y up in the picture."""
    direction = mathutils.Vector(target) - thing.location
    thing.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


# ---- materials -----------------------------------------------------------------------------


def principled(name, color, **inputs):
    """A Principled BSDF; further inputs by Blender's names, blanks written as underscores."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return material


def lambert(name, color):
    """A matte material; finish() makes it exactly Lambert in the file and for Cycles."""
    material = principled(name, color, Roughness=1.0, Specular=0.0)
    material["lambert"] = True
    return material


def glass(name, ior, color=(1.0, 1.0, 1.0), abbe=None, priority=0):
    """Smooth solid glass. The Abbe number, and the priority where solids overlap, are written by
    finish(); Cycles knows neither."""
    material = principled(name, color, Roughness=0.0, Transmission=1.0, IOR=ior)
    if abbe:
        material["abbe"] = abbe
    if priority:
        material["priority"] = priority
    return material


def ceramic(name, color, roughness=0.0):
    """A coloured body under a clear glaze of ior 1.5."""
    return principled(name, color, Roughness=roughness, Specular=0.5)


def metal(name, color, roughness):
    return principled(name, color, Metallic=1.0, Roughness=roughness)


def emitter(name, color, strength):
    """Shines from its front only: glTF's doubleSided is false, as Backface Culling says."""
    material = lambert(name, (0.0, 0.0, 0.0))
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission"].default_value = (*color, 1.0)
    shader.inputs["Emission Strength"].default_value = strength
    material.use_backface_culling = True
    return material


def use_texture(material, image):
    """Takes the base colour from an image."""
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])


# ---- export --------------------------------------------------------------------------------


def export_glb(path, edit=None):
    """Writes the scene, then corrects what Blender 3.4 cannot say; edit(gltf) has the last word."""
    bpy.ops.export_scene.gltf(
        filepath=path,
        export_format="GLB",
        export_cameras=True,
        export_lights=True,
        export_animations=bool(bpy.data.actions),
        export_apply=True,
        export_texcoords=any(mesh.uv_layers for mesh in bpy.data.meshes),
    )
    edit_glb(path, correct_materials)
    if edit:
        edit_glb(path, edit)


def correct_materials(gltf):
    """Writes into the materials what the scripts have noted on Blender's."""
    for material in gltf["materials"]:
        noted = bpy.data.materials[material["name"]]
        if noted.get("lambert"):
            make_lambert(gltf, material)
        if noted.get("abbe"):
            dispersion = {"dispersion": round(20.0 / noted["abbe"], 6)}
            add_extension(gltf, material, "KHR_materials_dispersion", dispersion)
        if noted.get("priority"):
            material["extras"] = {"ppm_priority": noted["priority"]}


def add_extension(gltf, material, name, values):
    material.setdefault("extensions", {})[name] = values
    if name not in gltf.setdefault("extensionsUsed", []):
        gltf["extensionsUsed"].append(name)


def make_lambert(gltf, material):
    """Takes the specular lobe from a material.

    Blender 3.4 writes Principled's "Specular 0" as specularColorFactor 0, which by
    KHR_materials_specular only takes F0 to 0: F90 stays 1 and the wall mirrors at grazing
    angles, which Cycles does not show. specularFactor 0 takes both away.
    """
    add_extension(gltf, material, "KHR_materials_specular", {"specularFactor": 0})


def edit_glb(path, edit):
    """Rewrites the JSON chunk of a binary glTF after edit(json) has changed it."""
    with open(path, "rb") as file:
        data = file.read()
    json_size = struct.unpack_from("<I", data, 12)[0]
    gltf = json.loads(data[20 : 20 + json_size])
    edit(gltf)
    text = json.dumps(gltf, separators=(",", ":")).encode("utf-8")
    text += b" " * (-len(text) % 4)
    rest = data[20 + json_size :]
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)))
        file.write(struct.pack("<I4s", len(text), b"JSON"))
        file.write(text)
        file.write(rest)


def export_obj(path, materials, comment):
    """Writes the meshes as PATH.obj and PATH.mtl, in metres with +Y up; materials has for each name
    the statements of it. No normals: smooth faces are in one smoothing group, which means them."""
    lines = [f"# {comment}", f"mtllib {os.path.basename(path)}.mtl"]
    first = 1
    for thing in bpy.context.scene.objects:
        if thing.type != "MESH":
            continue
        mesh = thing.data
        lines.append(f"o {thing.name}")
        for vertex in mesh.vertices:
            x, y, z = thing.matrix_world @ vertex.co
            lines.append("v " + " ".join(f"{value:.6f}" for value in (x, z, -y)))
        lines.append(f"usemtl {mesh.materials[0].name}")
        lines.append("s 1" if mesh.polygons[0].use_smooth else "s off")
        lines += ["f " + " ".join(str(first + k) for k in face.vertices) for face in mesh.polygons]
        first += len(mesh.vertices)
    write_lines(path + ".obj", lines)
    lines = [f"# {comment}"]
    for name, statements in materials.items():
        lines += [f"newmtl {name}", *statements]
    write_lines(path + ".mtl", lines)


def write_lines(path, lines):
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


# ---- Cycles reference ----------------------------------------------------------------------


def render_cycles(path, samples, threads=1):
    """A scene-linear EXR by Cycles' path tracer, set for comparison rather than for beauty."""
    for material in bpy.data.materials:
        if material.get("lambert"):
            use_diffuse_node(material)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.render.filepath = path
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    for limit in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, limit + "_bounces", 32)
    bpy.ops.render.render(write_still=True)


def use_diffuse_node(material):
    """Replaces Principled by a Diffuse BSDF (and Emission, front only, if it shines).

    Principled's diffuse lobe is Disney's in Blender 3.x, up to 40 % brighter than Lambert in
    the corners of a closed box, so it must not be what a Lambert wall is compared with.
    """
    tree = material.node_tree
    old = tree.nodes["Principled BSDF"]
    strength = old.inputs["Emission Strength"].default_value
    emission = [strength * c for c in old.inputs["Emission"].default_value[:3]]
    if max(emission) > 0.0:
        new = tree.nodes.new("ShaderNodeEmission")
        front = tree.nodes.new("ShaderNodeMath")
        front.operation = "SUBTRACT"
        front.inputs[0].default_value = 1.0
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(geometry.outputs["Backfacing"], front.inputs[1])
        tree.links.new(front.outputs[0], new.inputs["Strength"])
        new.inputs["Color"].default_value = (*emission, 1.0)
    else:
        new = tree.nodes.new("ShaderNodeBsdfDiffuse")
        color = old.inputs["Base Color"]
        new.inputs["Color"].default_value = color.default_value
        if color.is_linked:
            tree.links.new(color.links[0].from_socket, new.inputs["Color"])
    output = tree.nodes["Material Output"]
    tree.links.new(new.outputs[0], output.inputs["Surface"])


# ---- the script's end ----------------------------------------------------------------------


def finish(script, edit=None):
    """Exports SCRIPT.glb beside the script; after `-- --reference OUT.exr SAMPLES` renders too."""
    export_glb(os.path.splitext(os.path.abspath(script))[0] + ".glb", edit)
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    if not arguments:
        return
    if len(arguments) != 3 or arguments[0] != "--reference" or not arguments[2].isdigit():
        sys.exit("usage, after Blender's options: -- --reference OUT.exr SAMPLES")
    render_cycles(os.path.abspath(arguments[1]), int(arguments[2]))
