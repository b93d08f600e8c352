# SPDX-License-Identifier: MIT
"""Compares what Blender's Cycles renders with what glim renders of its export.

usage: blender -b --factory-startup -P blender.py -- GLIM FOLDER [MATERIAL...]
or, with Blender as a Python module: python3 blender.py -- GLIM FOLDER ...

A ball with one material after another stands on a grey floor below a lamp and a
grey sky. Each material is exported in both modes of the OBJ exporter, and as
glTF; there the floor has the Principled BSDF, the only one that its exporter
knows. A row compares the means of pictures over the ball and over the floor: the largest
difference of a channel, relative to the mean of the region. Where both programs
mean the same by a material it must be at most TOLERANCE; where they do not, the
row says why, and nothing is wanted. Cycles renders without bias: no clamps, no
filters, no adaptive sampling, no denoising.
"""
import math
import os
import subprocess
import sys

import bpy
import numpy

WIDTH, HEIGHT = 128, 96
SPP = 400
TOLERANCE = 0.015
FOVY = 30.0
EYE, AT = (0.0, -7.0, 2.0), (0.0, 0.0, -0.1)
SKY = 0.5

# Sockets of the Principled BSDF before version 4 where the names differ.
OLD_NAMES = {
    "Specular IOR Level": "Specular",
    "Transmission Weight": "Transmission",
    "Coat Weight": "Clearcoat",
    "Coat Roughness": "Clearcoat Roughness",
    "Sheen Weight": "Sheen",
    "Emission Color": "Emission",
}

LOST = "classic files lack it"
SHEET = "glTF has a sheet of glass where no thickness is given"
NO_GLTF = "the exporter before 4 lacks it"
BENT = "Cycles loses what bent normals send below the surface"
DIFFUSE = "Cycles before 4 has Disney's diffuse light"
RED, GOLD, WHITE = (0.8, 0.3, 0.1, 1), (1, 0.7, 0.2, 1), (1, 1, 1, 1)

# Name, sockets, reasons for a difference: in classic files, with the extension,
# and in both if Blender is older than 4. IN_GLTF has those for glTF; without one
# there it is that of the extension.
MATERIALS = [
    ("diffuse", {"Base Color": RED, "Specular IOR Level": 0.0,
                 "Roughness": 1.0}, "", "", DIFFUSE),
    ("plastic", {"Base Color": RED, "Roughness": 0.3}, "", "", DIFFUSE),
    ("metal", {"Base Color": GOLD, "Metallic": 1.0, "Roughness": 0.2},
     "", "", ""),
    ("rough_metal", {"Base Color": GOLD, "Metallic": 1.0, "Roughness": 0.6},
     "", "", ""),
    ("half_metal", {"Base Color": GOLD, "Metallic": 0.5, "Roughness": 0.4},
     "", "", DIFFUSE),
    ("glass", {"Base Color": WHITE, "Transmission Weight": 1.0,
               "Roughness": 0.0, "IOR": 1.45}, LOST, "", ""),
    ("glow", {"Base Color": (0, 0, 0, 1), "Emission Color": (1, 0.5, 0.2, 1),
              "Emission Strength": 3.0, "Specular IOR Level": 0.0},
     "", "", ""),
    ("alpha", {"Base Color": RED, "Specular IOR Level": 0.0,
               "Roughness": 1.0, "Alpha": 0.3}, "", "", DIFFUSE),
    ("normal_map", {"Base Color": RED, "Specular IOR Level": 0.0,
                    "Roughness": 1.0}, BENT, BENT, DIFFUSE),
    ("half_normal_map", {"Base Color": RED, "Specular IOR Level": 0.0,
                         "Roughness": 1.0}, BENT, BENT, DIFFUSE),
    ("coat", {"Base Color": RED, "Specular IOR Level": 0.0, "Roughness": 1.0,
              "Coat Weight": 0.7, "Coat Roughness": 0.1}, LOST, "", DIFFUSE),
    ("sheen", {"Base Color": RED, "Specular IOR Level": 0.0, "Roughness": 1.0,
               "Sheen Weight": 0.6}, LOST,
     "Cycles has other fits of sheen", ""),
    ("aniso", {"Base Color": GOLD, "Metallic": 1.0, "Roughness": 0.5,
               "Anisotropic": 0.8}, LOST,
     "Cycles 5 loses 8 % of a white furnace's light at stretched facets", ""),
]

IN_GLTF = {"glass": SHEET}
IN_OLD_GLTF = {"diffuse": DIFFUSE, "glow": NO_GLTF, "coat": NO_GLTF}


def set_sockets(shader, values):
    for name, value in values.items():
        if name not in shader.inputs:
            name = OLD_NAMES[name]
        shader.inputs[name].default_value = value


def waves(path):
    """Writes a normal map of waves along u and v."""
    size = 64
    image = bpy.data.images.new("waves", size, size, float_buffer=False)
    image.colorspace_settings.name = "Non-Color"
    at = (numpy.arange(size) + 0.5) / size * 8 * math.pi
    u, v = numpy.meshgrid(0.4 * numpy.sin(at), 0.4 * numpy.sin(at))
    n = numpy.stack([u, v, numpy.ones_like(u)], -1)
    n /= numpy.linalg.norm(n, axis=-1, keepdims=True)
    rgba = numpy.concatenate([n / 2 + 0.5, numpy.ones((size, size, 1))], -1)
    image.pixels = rgba.astype(numpy.float32).ravel()
    image.filepath_raw, image.file_format = path, "PNG"
    image.save()
    return image


def principled(name, values, folder):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    if hasattr(shader, "distribution"):
        shader.distribution = "MULTI_GGX"  # conserves energy, as glim
    set_sockets(shader, values)
    if "normal_map" in name:
        image = nodes.new("ShaderNodeTexImage")
        image.image = waves(os.path.join(folder, "waves.png"))
        bump = nodes.new("ShaderNodeNormalMap")
        links.new(image.outputs["Color"], bump.inputs["Color"])
        bump.inputs["Strength"].default_value = 0.5 if "half" in name else 1
        links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    return material


def lambert(name, grey):
    """Returns a diffuse material. The exporter, which knows only the Principled
    BSDF, takes the numbers of the viewport."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.remove(nodes["Principled BSDF"])
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (grey, grey, grey, 1)
    links.new(shader.outputs[0], nodes["Material Output"].inputs["Surface"])
    material.diffuse_color = (grey, grey, grey, 1)
    material.specular_intensity, material.roughness = 0, 1
    return material


def build(folder):
    """Makes the scene; returns the ball."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_plane_add(size=12, location=(0, 0, -1))
    bpy.context.object.data.materials.append(lambert("floor", 0.5))
    bpy.ops.mesh.primitive_plane_add(size=2, location=(-2, -1, 4))
    bpy.context.object.data.materials.append(principled(
        "lamp", {"Base Color": (0, 0, 0, 1), "Specular IOR Level": 0.0,
                 "Emission Color": WHITE, "Emission Strength": 6.0}, folder))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    return ball


def export_gltf(path, folder):
    """Exports the scene as glTF, with a floor that its exporter knows."""
    floor = next(o for o in bpy.data.objects
                 if o.data and o.data.name.startswith("Plane")
                 and o.data.materials[0].name == "floor")
    kept = floor.data.materials[0]
    floor.data.materials[0] = principled(
        "floor_gltf", {"Base Color": (0.5, 0.5, 0.5, 1),
                       "Specular IOR Level": 0.0, "Roughness": 1.0}, folder)
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB",
                              export_lights=False, export_cameras=False,
                              export_tangents=True)
    floor.data.materials[0] = kept


def look(scene):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", math.radians(FOVY)
    camera = bpy.data.objects.new("camera", data)
    direction = [a - e for a, e in zip(AT, EYE)]
    pitch = math.atan2(direction[2], direction[1])
    camera.location = EYE
    camera.rotation_euler = (math.pi / 2 + pitch, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_up(scene):
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_x, render.resolution_y = WIDTH, HEIGHT
    render.resolution_percentage = 100
    cycles.samples = SPP
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", 64)
    cycles.transparent_max_bounces = 64
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (
        SKY, SKY, SKY, 1)
    scene.world = world
    look(scene)


def cycles_picture(scene, folder):
    """Returns the picture, the top row first."""
    path = os.path.join(folder, "cycles.exr")
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.ops.render.render()
    bpy.data.images["Render Result"].save_render(path)
    image = bpy.data.images.load(path)
    pixels = numpy.array(image.pixels[:]).reshape(HEIGHT, WIDTH, 4)
    bpy.data.images.remove(image)
    return pixels[::-1, :, :3]


def glim_picture(glim, obj, folder):
    out = os.path.join(folder, "glim.pfm")
    with open(os.path.join(folder, "view"), "w") as view:
        # OBJ files have y up: (x, y, z) is written as (x, z, -y)
        view.write("eye %g %g %g\nat %g %g %g\nfovy %g\nbackground %g %g %g\n"
                   % (EYE[0], EYE[2], -EYE[1], AT[0], AT[2], -AT[1], FOVY,
                      SKY, SKY, SKY))
    subprocess.run([glim, "-b", "-c", view.name, "-w", str(WIDTH),
                    "-h", str(HEIGHT), "-s", str(SPP), "-o", out, obj],
                   check=True, stderr=subprocess.DEVNULL)
    with open(out, "rb") as pfm:
        pfm.readline(), pfm.readline(), pfm.readline()
        pixels = numpy.frombuffer(pfm.read(), "<f4")
    return pixels.reshape(HEIGHT, WIDTH, 3)[::-1]


def ball_mask():
    """Returns 1 for pixels well inside of the ball, -1 for those well outside
    and below the horizon."""
    eye, at = numpy.array(EYE), numpy.array(AT)
    ahead = (at - eye) / numpy.linalg.norm(at - eye)
    right = numpy.cross(ahead, (0, 0, 1))
    right /= numpy.linalg.norm(right)
    up = numpy.cross(right, ahead)
    half = math.tan(math.radians(FOVY) / 2)
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    across = ((x + 0.5) / WIDTH * 2 - 1) * half * WIDTH / HEIGHT
    upwards = (1 - (y + 0.5) / HEIGHT * 2) * half
    ray = (ahead + across[..., None] * right + upwards[..., None] * up)
    ray /= numpy.linalg.norm(ray, axis=-1, keepdims=True)
    distance = numpy.linalg.norm(numpy.cross(ray, -eye), axis=-1)
    is_floor = (distance > 1.08) & (ray[..., 2] < -0.2)
    return numpy.where(distance < 0.97, 1, numpy.where(is_floor, -1, 0))


def difference(a, b, mask, sign):
    """Returns the largest relative difference of the means of a region."""
    a, b = a[mask == sign].mean(0), b[mask == sign].mean(0)
    return abs(a - b).max() / b.mean(), a, b


def triple(mean):
    return " ".join("%.3f" % x for x in mean)


def compare(name, mode, reason, ours, theirs, mask):
    ball, a, b = difference(ours, theirs, mask, 1)
    floor, _, _ = difference(ours, theirs, mask, -1)
    worst = max(ball, floor)
    word = "ok" if reason or worst <= TOLERANCE else "FAIL"
    print("%s Blender %s %s, %s: ball %s, Cycles %s: differs by %.1f %%, floor by "
          "%.1f %%%s" % (word, bpy.app.version_string.split()[0], name, mode,
                         triple(a), triple(b), 100 * ball, 100 * floor,
                         reason and " (" + reason + ")"),
          flush=True)
    return word == "ok"


def main():
    glim, folder, *wanted = sys.argv[sys.argv.index("--") + 1:]
    is_old = bpy.app.version < (4, 0, 0)
    scene = bpy.context.scene
    ball = build(folder)
    set_up(scene)
    mask = ball_mask()
    all_ok = True
    for name, values, classic, extended, old in MATERIALS:
        if wanted and name not in wanted:
            continue
        ball.data.materials.clear()
        ball.data.materials.append(principled(name, values, folder))
        theirs = cycles_picture(scene, folder)
        for is_extended, reason in ((False, classic), (True, extended)):
            obj = os.path.join(folder, name + "_%d.obj" % is_extended)
            bpy.ops.wm.obj_export(filepath=obj, export_pbr_extensions=is_extended,
                                  export_uv=True, export_normals=True,
                                  path_mode="ABSOLUTE")
            ours = glim_picture(glim, obj, folder)
            mode = "with the extension" if is_extended else "classic"
            all_ok &= compare(name, mode, reason or (old if is_old else ""),
                              ours, theirs, mask)
        glb = os.path.join(folder, name + ".glb")
        export_gltf(glb, folder)
        reason = IN_GLTF.get(name, extended)
        if is_old:
            reason = reason or IN_OLD_GLTF.get(name, old)
        all_ok &= compare(name, "glTF", reason,
                          glim_picture(glim, glb, folder), theirs, mask)
    sys.exit(not all_ok)


main()
