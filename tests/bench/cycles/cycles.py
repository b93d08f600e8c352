# SPDX-License-Identifier: MIT
"""Camera paths per second of Cycles, for tests/bench/cycles/run.sh.

usage: blender -b --factory-startup -P cycles.py -- SCENE.obj THREADS OUT SPP...

SCENE.obj has diffuse and emitting materials; camera.txt beside it has the view.
Prints "cycles SPP SECONDS SECONDS" for each number of samples per pixel: the
time by the clock and the processor time. OUT0.pfm and OUT1.pfm are two pictures
with the last number and different noise. Biased techniques are off, as in glim:
clamps, filters, adaptive sampling, denoising. Paths have the scene's limit of
bounces.
"""
import array
import math
import os
import sys
import time

import bpy
from mathutils import Matrix, Vector


def numbers(path):
    """Returns a map from keys to the numbers on their lines."""
    lines = (line.split("#")[0].split() for line in open(path))
    return {w[0]: [float(x) for x in w[1:]] for w in lines if w}


def materials(path):
    """Returns a map from names and keys to words of an MTL file."""
    found = {}
    for words in (line.split() for line in open(path)):
        if words and words[0] == "newmtl":
            current = found.setdefault(words[1], {})
        elif words and words[0][0] != "#":
            current[words[0]] = words[1:]
    return found


def color(words):
    return [float(x) for x in words] + [1.0]


def shade(material, lines, folder):
    """Sets the material to its MTL lines."""
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if any(float(x) > 0 for x in lines.get("Ke", [])):
        shader = nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = color(lines["Ke"])
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = color(lines["Kd"])
    if "map_Kd" in lines:
        image = nodes.new("ShaderNodeTexImage")
        image.image = bpy.data.images.load(
            os.path.join(folder, lines["map_Kd"][-1]))
        links.new(image.outputs["Color"], shader.inputs["Color"])
    links.new(shader.outputs[0], output.inputs["Surface"])


def add_camera(scene, view):
    """Sets the camera. y is up as in the file: the import does not rotate."""
    eye, at, up = (Vector(view[k]) for k in ("eye", "at", "up"))
    back = (eye - at).normalized()
    right = up.cross(back).normalized()
    axes = Matrix((right, back.cross(right), back)).transposed().to_4x4()
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(view["fovy"][0])
    data.clip_end = 1e6
    camera = bpy.data.objects.new("camera", data)
    camera.matrix_world = Matrix.Translation(eye) @ axes
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_up(scene, view, threads):
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device = "CPU"
    render.threads_mode, render.threads = "FIXED", threads
    render.resolution_x, render.resolution_y = map(int, view["res"])
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", int(view["max_bounces"][0]))
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (
        view["background"] + [1.0])
    scene.world = world


def save(scene, path):
    """Writes the rendered picture as PFM."""
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.data.images["Render Result"].save_render(path + ".exr")
    image = bpy.data.images.load(path + ".exr")
    rgba = image.pixels[:]
    rgb = [x for i, x in enumerate(rgba) if i % 4 != 3]
    with open(path, "wb") as out:
        out.write(b"PF\n%d %d\n-1.0\n" % tuple(image.size))
        array.array("f", rgb).tofile(out)


def main():
    path, threads, out, *counts = sys.argv[sys.argv.index("--") + 1:]
    folder = os.path.dirname(os.path.abspath(path))
    view = numbers(os.path.join(folder, "camera.txt"))
    lines = materials(os.path.splitext(path)[0] + ".mtl")
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.import_scene.obj(filepath=path, axis_forward="Y", axis_up="Z")
    for material in bpy.data.materials:
        if material.name in lines:
            shade(material, lines[material.name], folder)
    add_camera(scene, view)
    set_up(scene, view, int(threads))
    for spp in ["1"] + counts:  # the first render loads what the others need
        scene.cycles.samples = int(spp)
        begin, busy = time.monotonic(), time.process_time()
        bpy.ops.render.render()
        print("cycles", spp, time.monotonic() - begin,
              time.process_time() - busy)
    save(scene, out + "0.pfm")
    scene.cycles.seed = 1
    bpy.ops.render.render()
    save(scene, out + "1.pfm")


main()
