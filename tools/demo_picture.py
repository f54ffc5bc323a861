# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a matched pair: the objects in colours, the matched points as beads, lines between them."""

from __future__ import annotations

from math import radians
from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["add_beads", "add_lines", "paint", "paint_plain", "render", "set_stage", "sheet"]

_FLOOR = (0.62, 0.63, 0.65)
_SKY = (0.95, 0.97, 1.0)
_SKY_STRENGTH = 0.45

# Suns, seen from the camera: degrees to the right and up, strength, and how wide they are in degrees (soft shadows).
_SUNS = ((-40, 48, 1.9, 18), (65, 20, 0.35, 40), (160, 35, 0.8, 25))


def paint(thing: bpy.types.Object, color_attribute: str, *, whitened: float = 0.0, roughness: float = 0.55) -> None:
    """Give an object a material that shows a color attribute, with a share of white mixed in."""
    material = bpy.data.materials.new(f"{thing.name} {color_attribute}")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    tree = material.node_tree
    surface = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    surface.inputs["Roughness"].default_value = roughness
    color = tree.nodes.new("ShaderNodeVertexColor")
    color.layer_name = color_attribute
    color.location = surface.location + Vector((-400, 0))
    white = tree.nodes.new("ShaderNodeMix")
    white.data_type = "RGBA"
    white.location = surface.location + Vector((-200, 0))
    # The node has sockets of the same names for each type; their identifiers differ.
    sockets = {socket.identifier: socket for socket in (*white.inputs, *white.outputs)}
    sockets["Factor_Float"].default_value, sockets["B_Color"].default_value = whitened, (1, 1, 1, 1)
    tree.links.new(color.outputs["Color"], sockets["A_Color"])
    tree.links.new(sockets["Result_Color"], surface.inputs["Base Color"])
    thing.data.materials.clear()
    thing.data.materials.append(material)


def add_beads(name: str, places: NDArray[np.float64], colors: NDArray[np.float64], radius: float) -> bpy.types.Object:
    """Add an object of small balls at places (k, 3) in the world, in linear colours (k, 4)."""
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=3, radius=radius)
    vertices = np.array([vertex.co for vertex in ball.verts])
    faces = np.array([[vertex.index for vertex in face.verts] for face in ball.faces])
    ball.free()
    starts = len(vertices) * np.arange(len(places))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        (places[:, None] + vertices).reshape(-1, 3).tolist(),
        [],
        (starts[:, None, None] + faces).reshape(-1, 3).tolist(),
    )
    mesh.shade_smooth()
    attribute = mesh.attributes.new("Color", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.repeat(colors, len(vertices), axis=0).astype(np.float32).ravel())
    beads = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(beads)
    paint(beads, "Color", roughness=0.25)
    return beads


def add_lines(
    name: str, starts: NDArray[np.float64], ends: NDArray[np.float64], colors: NDArray[np.float64], radius: float
) -> bpy.types.Object:
    """Add an object of thin bars from places (k, 3) to places (k, 3) in the world, in linear colours (k, 4)."""
    along = ends - starts
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), np.finfo(float).tiny)
    side = np.cross(along, np.eye(3)[np.abs(along).argmin(axis=1)])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angle = np.arange(3) * 2 * np.pi / 3
    ring = radius * (np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * np.cross(along, side)[:, None])
    vertices = np.concatenate([starts[:, None] + ring, ends[:, None] + ring], axis=1)  # (k, 6, 3)
    quads = np.array([[i, (i + 1) % 3, 3 + (i + 1) % 3, 3 + i] for i in range(3)])
    faces = 6 * np.arange(len(starts))[:, None, None] + quads
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.reshape(-1, 3).tolist(), [], faces.reshape(-1, 4).tolist())
    attribute = mesh.attributes.new("Color", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.repeat(colors, 6, axis=0).astype(np.float32).ravel())
    bars = bpy.data.objects.new(name, mesh)
    bars.visible_shadow = False
    bpy.context.scene.collection.objects.link(bars)
    paint(bars, "Color", roughness=1.0)
    return bars


def paint_plain(thing: bpy.types.Object, color: tuple[float, float, float, float]) -> None:
    """Give an object one colour."""
    thing.data.materials.clear()
    _fill(thing, color[:3])


def sheet(rows: list[list[Path]], path: Path) -> None:
    """Put pictures of one size together, row by row, and save them as one."""
    made = []
    for row in rows:
        pictures = []
        for image_path in row:
            image = bpy.data.images.load(str(image_path))
            width, height = image.size
            pixels = np.empty(4 * width * height, np.float32)
            image.pixels.foreach_get(pixels)
            pictures.append(pixels.reshape(height, width, 4))
            bpy.data.images.remove(image)
        made.append(np.concatenate(pictures, axis=1))
    whole = np.concatenate(made[::-1], axis=0)  # Blender's pictures start at the bottom
    image = bpy.data.images.new(path.stem, whole.shape[1], whole.shape[0])
    image.pixels.foreach_set(np.ascontiguousarray(whole).ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


def set_stage(things: list[bpy.types.Object], direction: tuple[float, float], width: int, height: int) -> None:
    """Add floor, light and a camera that looks at all of some objects.

    Parameters
    ----------
    things : list of bpy.types.Object
        What shall be seen.
    direction : (float, float)
        Where the camera stands: degrees around Z from -Y towards +X, and up.
    width, height : int
        Size of the picture in pixels.
    """
    scene = bpy.context.scene
    bpy.context.view_layer.update()
    corners = np.array([thing.matrix_world @ Vector(corner) for thing in things for corner in thing.bound_box])
    low, high = corners.min(axis=0), corners.max(axis=0)
    centre, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100

    lens = bpy.data.cameras.new("Camera")
    lens.lens = 70
    camera = bpy.data.objects.new("Camera", lens)
    _aim(camera, centre, direction, 5 * radius)
    scene.collection.objects.link(camera)
    scene.camera = camera
    vertices = np.concatenate([_world_vertices(thing) for thing in things])
    bpy.context.view_layer.update()
    camera.location, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), vertices.ravel().tolist())
    camera.location += 0.06 * (camera.location - Vector(centre))

    for number, (right, up, strength, spread) in enumerate(_SUNS, 1):
        light = bpy.data.lights.new(f"Sun {number}", "SUN")
        light.energy, light.angle = strength, radians(spread)
        lamp = bpy.data.objects.new(light.name, light)
        _aim(lamp, centre, (direction[0] + right, up), 3 * radius)
        scene.collection.objects.link(lamp)

    floor = bpy.data.meshes.new("Floor")
    half = 60 * radius
    floor.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    ground = bpy.data.objects.new("Floor", floor)
    ground.location = (centre[0], centre[1], low[2])
    scene.collection.objects.link(ground)
    _fill(ground, _FLOOR)
    world = scene.world or bpy.data.worlds.new("World")
    scene.world = world
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*_SKY, 1)
    background.inputs["Strength"].default_value = _SKY_STRENGTH


def render(path: Path, samples: int) -> None:
    """Render the scene with Cycles on the CPU."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.seed = 0
    scene.cycles.use_denoising = True
    scene.cycles.max_bounces = 3
    # The colours of the file, not those of a film.
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def _aim(thing: bpy.types.Object, centre: NDArray[np.float64], direction: tuple[float, float], distance: float) -> None:
    """Put a camera or lamp at a distance from a place, looking at it."""
    turn = Matrix.Rotation(radians(direction[0]), 3, "Z") @ Matrix.Rotation(radians(90 - direction[1]), 3, "X")
    thing.matrix_world = turn.to_4x4()
    thing.location = Vector(centre) + distance * (turn @ Vector((0, 0, 1)))


def _world_vertices(thing: bpy.types.Object) -> NDArray[np.float64]:
    flat = np.empty(3 * len(thing.data.vertices), np.float32)
    thing.data.vertices.foreach_get("co", flat)
    matrix = np.array(thing.matrix_world)
    return flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def _fill(thing: bpy.types.Object, color: tuple[float, float, float]) -> None:
    """Give an object a dull material of one colour."""
    material = bpy.data.materials.new(thing.name)
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    surface = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    surface.inputs["Base Color"].default_value = (*color, 1)
    surface.inputs["Roughness"].default_value = 0.9
    thing.data.materials.append(material)
