# SPDX-License-Identifier: GPL-3.0-or-later
"""A pair of cats to try the matching on: one body, two meshes, two poses, and the true correspondence.

Both meshes are cut from the same surface in its rest pose.  Each vertex keeps its place there in the attribute
`REST_ATTRIBUTE` when an armature moves it, so the true image of a point is the point of the other cat with the same
rest place.
"""

from __future__ import annotations

from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple, cast

import bmesh
import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector
from mathutils.bvhtree import BVHTree
from mathutils.interpolate import poly_3d_calc

from ..common.access import mesh_of, open_collections, view_layer_of
from .demo_cat import add_modifier, build_body
from .demo_rig import rig_cat
from .demo_skeleton import BONES, STANDING, WALKING, bone_weights, build_armature, set_pose
from .demo_store import STORED_SIZES, Cat, load_cats

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .demo_skeleton import Pose

REST_ATTRIBUTE: Final = "hm_rest"
"""Name of the attribute with the place of each vertex in the rest pose, common to both cats."""

SOURCE_NAME: Final = "Demo Cat Standing"
TARGET_NAME: Final = "Demo Cat Walking"

# The target comes as if imported from another program: in centimetres, Y up, and a little larger.
_TARGET_UNIT = 100.0
_TARGET_SIZE = 1.12
_Y_UP = Matrix.Rotation(np.radians(-90), 4, "X")

# How the cats stand: place beside the 3D cursor, and heading about Z in degrees.
_SOURCE_PLACE, _SOURCE_HEADING = (-0.95, -1.05, 0.0), -8.0
_TARGET_PLACE, _TARGET_HEADING = (0.95, 0.85, 0.0), -36.0

# How far the cats stand from what would be in their way.
_ASIDE = 0.3

# How often the faces of both are evened out.
_RELAXATIONS = 5

# Width of the voxels from which both meshes are thinned out, and how they stand to the body: at two attitudes, so that
# the meshes have nothing in common.
_VOXEL = 0.0125
_SOURCE_ATTITUDE = Euler((0.4, 0.7, 0.3)).to_matrix()
_TARGET_ATTITUDE = Euler((1.0, 0.2, 0.5)).to_matrix()


class _Surface(NamedTuple):
    """Vertices (n, 3), and the corners of each face."""

    vertices: NDArray[np.float64]
    faces: list[list[int]]


def add_demo_pair(
    context: bpy.types.Context, *, source_vertices: int = 5500, target_vertices: int = 4000, rigged: bool = False
) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Add the two cats to the scene, beside the 3D cursor, selected and with the source active.

    Parameters
    ----------
    context : bpy.types.Context
        Where to add them; in Object Mode.
    source_vertices, target_vertices : int
        About how many vertices the meshes get; the source is mostly quads, the target triangles.
    rigged : bool
        Whether the source gets an armature, weights, shape keys and a UV map.

    Returns
    -------
    source, target : bpy.types.Object
        The new objects.
    """
    sizes = (source_vertices, target_vertices)
    standing, walking = load_cats() if sizes == STORED_SIZES else build_cats(*sizes)
    source = _finished(SOURCE_NAME, standing, Matrix())
    target = _finished(TARGET_NAME, walking, Matrix.Scale(_TARGET_UNIT, 4) @ _Y_UP)
    place = _standing_at(_SOURCE_PLACE, _SOURCE_HEADING)
    other_place = _standing_at(_TARGET_PLACE, _TARGET_HEADING)
    cats = (place, standing.posed), (other_place, _TARGET_SIZE * walking.posed)
    points = np.concatenate([vertices @ np.array(to.to_3x3()).T + to.translation for to, vertices in cats])
    origin = _clear_place(context, points.min(axis=0), points.max(axis=0))
    source.matrix_world = origin @ place
    if rigged:
        with _workshop() as scene:
            rig_cat(context, source, build_armature("hm_armature", scene), standing.weights, standing.lift)
    unit = Matrix.Scale(_TARGET_SIZE / _TARGET_UNIT, 4) @ _Y_UP.inverted()
    target.matrix_world = origin @ other_place @ unit
    _show(context, source, target)
    return source, target


@lru_cache(maxsize=1)
def build_cats(source_vertices: int, target_vertices: int) -> tuple[Cat, Cat]:
    """Build the two cats; those that were built last are remembered.

    Parameters
    ----------
    source_vertices, target_vertices : int
        About how many vertices they get.

    Returns
    -------
    source, target : Cat
        The standing and the walking one.
    """
    with _workshop() as scene:
        body = build_body("hm_body")
        scene.collection.objects.link(body)
        rest = _Rest(_evaluated(scene, body))
        armature = build_armature("hm_armature", scene)
        source = _with_quads(_remeshed(scene, rest, source_vertices, _SOURCE_ATTITUDE))
        target = _remeshed(scene, rest, target_vertices, _TARGET_ATTITUDE)
        return _posed(scene, armature, STANDING, source, rest), _posed(scene, armature, WALKING, target, rest)


def _clear_place(context: bpy.types.Context, low: NDArray[np.float64], high: NDArray[np.float64]) -> Matrix:
    """Find where a box (3,) to (3,) about the 3D cursor touches no visible object: there, or along the X axis."""
    origin = np.array(cast("bpy.types.Scene", context.scene).cursor.location, np.float64)
    boxes = []
    for thing in context.visible_objects:
        corners = np.array([thing.matrix_world @ Vector(corner) for corner in thing.bound_box])
        if np.ptp(corners, axis=0).any():  # cameras, lights and empties have no size
            boxes.append((corners.min(axis=0), corners.max(axis=0)))
    for least, most in sorted(boxes, key=lambda box: float(box[0][0])):
        if (least < origin + high).all() and (most > origin + low).all():
            origin[0] = most[0] - low[0] + _ASIDE
    return Matrix.Translation(Vector(origin.tolist()))


def _show(context: bpy.types.Context, source: bpy.types.Object, target: bpy.types.Object) -> None:
    """Put the cats where the user looks, select them, and pick them in the panel."""
    for thing in context.selected_objects:
        thing.select_set(state=False)
    scene: Any = context.scene
    view = context.space_data
    for cat in (source, target):
        open_collections(context, [cast("bpy.types.Collection", context.collection)])[0].objects.link(cat)
        cat.select_set(state=True)
        if isinstance(view, bpy.types.SpaceView3D) and view.local_view:
            cat.local_view_set(view, state=True)
    view_layer_of(context).objects.active = source
    if hasattr(scene, "hiermatch"):
        scene.hiermatch.source, scene.hiermatch.target = source, target


@contextmanager
def _workshop() -> Iterator[bpy.types.Scene]:
    """Make a scene to work in; it goes with all that was put in it."""
    scene = bpy.data.scenes.new("hm_workshop")
    try:
        yield scene
    finally:
        for thing in list(scene.collection.objects):
            data = thing.data
            bpy.data.objects.remove(thing)
            bpy.data.batch_remove([data])
        bpy.data.scenes.remove(scene)


class _Rest:
    """The cat's surface in the rest pose, and how its bones move it."""

    def __init__(self, surface: _Surface) -> None:
        self.surface = surface
        self._tree: Any = BVHTree.FromPolygons(surface.vertices.tolist(), surface.faces)
        self._weights = bone_weights(surface.vertices, _edges(surface.faces))

    def project(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Find the nearest places (n, 3) of the surface to points (n, 3), and the unit normals there (n, 3)."""
        found = [self._tree.find_nearest(point)[:2] for point in points.tolist()]
        places, normals = np.moveaxis(np.array(found), 1, 0)
        return places, normals

    def relaxed(self, surface: _Surface) -> _Surface:
        """Even out the faces of another mesh of this surface, with its vertices on it."""
        faces = surface.faces
        vertices, normals = self.project(surface.vertices)
        for _ in range(_RELAXATIONS):
            faces = _beautified(_Surface(vertices, faces)).faces
            edges = _edges(faces)
            both = np.concatenate([edges, edges[:, ::-1]])
            count = np.bincount(both[:, 0])
            mean = np.stack([np.bincount(both[:, 0], column[both[:, 1]]) / count for column in vertices.T], axis=1)
            move = mean - vertices
            # Only along the surface: what is pointed stays pointed.
            move -= (move * normals).sum(axis=1, keepdims=True) * normals
            vertices, normals = self.project(vertices + move / 2)
        return _Surface(vertices, faces)

    def weights_at(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Interpolate the weight of each bone at places (n, 3) of the surface, (n, bones)."""
        weights = np.empty((len(places), len(BONES)))
        for i, place in enumerate(places.tolist()):
            nearest, _, face, _ = self._tree.find_nearest(place)
            corners = self.surface.faces[face]
            shares = cast("Any", poly_3d_calc)(self.surface.vertices[corners].tolist(), nearest)
            weights[i] = np.array(shares) @ self._weights[corners]
        return weights


def _evaluated(scene: bpy.types.Scene, thing: bpy.types.Object) -> _Surface:
    """Read the mesh of an object as its modifiers leave it."""
    layer = scene.view_layers[0]
    layer.update()
    evaluated = thing.evaluated_get(cast("bpy.types.Depsgraph", layer.depsgraph))
    mesh = evaluated.to_mesh()
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    evaluated.to_mesh_clear()
    faces = [face.tolist() for face in np.split(corners, starts[1:])]
    return _Surface(vertices.reshape(-1, 3).astype(np.float64), faces)


def _edges(faces: list[list[int]]) -> NDArray[np.int64]:
    """List each edge of some faces once, (e, 2)."""
    edges = [(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1], strict=True)]
    return np.unique(np.sort(edges, axis=1), axis=0)


@contextmanager
def _editing(surface: _Surface) -> Iterator[bmesh.types.BMesh]:
    """Lend a surface as an edit mesh."""
    build = bmesh.new()
    try:
        vertices = [build.verts.new(vertex) for vertex in surface.vertices.tolist()]
        for face in surface.faces:
            build.faces.new([vertices[corner] for corner in face])
        build.verts.index_update()
        build.normal_update()
        yield build
    finally:
        build.free()


def _faces_of(build: bmesh.types.BMesh) -> list[list[int]]:
    return [[vertex.index for vertex in face.verts] for face in build.faces]


def _beautified(surface: _Surface) -> _Surface:
    """Turn the edges between triangles where that makes better triangles."""
    with _editing(surface) as build:
        bmesh.ops.beautify_fill(build, faces=list(build.faces), edges=list(build.edges), method="ANGLE")
        return _Surface(surface.vertices, _faces_of(build))


def _new_mesh(name: str, surface: _Surface) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(surface.vertices.tolist(), [], surface.faces)
    return mesh


def _new_object(scene: bpy.types.Scene, surface: _Surface) -> bpy.types.Object:
    """Put a surface into a scene."""
    thing = bpy.data.objects.new("hm_surface", _new_mesh("hm_surface", surface))
    scene.collection.objects.link(thing)
    return thing


def _remeshed(scene: bpy.types.Scene, rest: _Rest, vertex_count: int, attitude: Matrix) -> _Surface:
    """Cover the rest surface with about as many vertices in triangles, from voxels that stand askew to it."""
    turn = np.array(attitude)
    voxels = _new_object(scene, _Surface(rest.surface.vertices @ turn.T, rest.surface.faces))
    add_modifier(voxels, "REMESH", mode="VOXEL", voxel_size=_VOXEL)
    fine = _new_object(scene, _evaluated(scene, voxels))
    triangles = sum(len(face.vertices) - 2 for face in mesh_of(fine).polygons)
    # Euler: a triangulated sphere of n vertices has 2 n - 4 triangles.
    add_modifier(fine, "DECIMATE", ratio=(2 * vertex_count - 4) / triangles, use_collapse_triangulate=True)
    vertices, faces = _evaluated(scene, fine)
    return rest.relaxed(_Surface(vertices @ turn, faces))


def _with_quads(surface: _Surface) -> _Surface:
    """Join pairs of triangles to quads where that makes good quads."""
    with _editing(surface) as build:
        angle = np.radians(40.0)
        bmesh.ops.join_triangles(
            build, faces=list(build.faces), angle_face_threshold=angle, angle_shape_threshold=angle
        )
        return _Surface(surface.vertices, _faces_of(build))


def _posed(scene: bpy.types.Scene, armature: bpy.types.Object, pose: Pose, surface: _Surface, rest: _Rest) -> Cat:
    """Move the vertices of a surface in rest with the bones; feet on the ground."""
    thing = _new_object(scene, surface)
    weights = rest.weights_at(surface.vertices)
    for bone, column in zip(BONES, weights.T, strict=True):
        group = thing.vertex_groups.new(name=bone.name)
        for vertex in np.flatnonzero(column > 1e-4).tolist():
            group.add([vertex], column[vertex], "REPLACE")
    add_modifier(thing, "ARMATURE", object=armature, use_deform_preserve_volume=True)
    set_pose(armature, pose)
    vertices = _evaluated(scene, thing).vertices
    lift = -float(vertices[:, 2].min())
    return Cat(surface.vertices, vertices + np.array([0, 0, lift]), surface.faces, weights, lift)


def _finished(name: str, cat: Cat, frame: Matrix) -> bpy.types.Object:
    """Make the object: the posed vertices seen from a frame, and where they were in rest."""
    mesh = _new_mesh(name, _Surface(cat.posed, cat.faces))
    attribute: Any = mesh.attributes.new(REST_ATTRIBUTE, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", cat.rest.astype(np.float32).ravel())
    mesh.transform(frame)
    mesh.shade_smooth()
    return bpy.data.objects.new(name, mesh)


def _standing_at(place: tuple[float, float, float], heading: float) -> Matrix:
    return Matrix.Translation(place) @ Matrix.Rotation(np.radians(heading), 4, "Z")
