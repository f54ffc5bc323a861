# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays from and to Blender's meshes: the only place that reads vertices and writes attributes and weights.

Blender's bulk access wants flat, contiguous buffers of exactly its own number type: float32 and int32.
"""

from __future__ import annotations

import hashlib
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from mathutils import Matrix

from ...engine import MeshError, TriangleMesh
from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import bpy
    from numpy.typing import NDArray

_topologies: list[dict[int, str]] = []
"""What `topology` has found within each `unedited`, the innermost last."""

TOPOLOGY_MODIFIERS = frozenset(
    {
        "ARRAY",
        "BEVEL",
        "BOOLEAN",
        "BUILD",
        "DECIMATE",
        "EDGE_SPLIT",
        "EXPLODE",
        "FLUID",
        "MASK",
        "MESH_SEQUENCE_CACHE",
        "MIRROR",
        "MULTIRES",
        "NODES",
        "OCEAN",
        "PARTICLE_INSTANCE",
        "REMESH",
        "SCREW",
        "SKIN",
        "SOLIDIFY",
        "SUBSURF",
        "VOLUME_TO_MESH",
        "WELD",
        "WIREFRAME",
    }
)
"""Types of modifier that add, remove or renumber vertices."""


def read_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, *, use_modifiers: bool) -> TriangleMesh:
    """Read the surface of an object as it stands in the world.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object, not in Edit Mode.
    depsgraph : bpy.types.Depsgraph
        The evaluated dependency graph.
    use_modifiers : bool
        Whether to read the mesh after its shape keys and modifiers.

    Returns
    -------
    TriangleMesh
        World-space vertices, numbered as in the object's own mesh, and the triangles that Blender draws, with their
        normals outward even where the object's scale mirrors it.  Triangles that use a vertex twice are left out.

    Raises
    ------
    ObjectError
        If the mesh is no surface, or its modifiers change the number of vertices.
    """
    with _shown_mesh(obj, depsgraph, use_modifiers=use_modifiers) as mesh:
        positions = vertex_positions(mesh)
        mesh.calc_loop_triangles()
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
    shown = obj.evaluated_get(depsgraph).matrix_world
    matrix = np.array(shown if use_modifiers else rest_matrix(obj) or shown, dtype=np.float64)
    with np.errstate(invalid="ignore"):  # positions that are no numbers are told below
        vertices = positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = corners.reshape(-1, 3).astype(np.int64)
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    if len(triangles) and not proper.any():
        raise ObjectError(
            f'"{obj.name}" has no surface: each of its faces uses a vertex twice. Repair the mesh '
            "(in Edit Mode: Mesh > Clean Up > Degenerate Dissolve)."
        )
    try:
        return TriangleMesh(vertices, triangles[proper])
    except MeshError as error:
        raise ObjectError(f'"{obj.name}": {error}') from error


def rest_matrix(obj: bpy.types.Object) -> Matrix | None:
    """Return where an object that hangs on a bone stands while its armature is at rest; None if it hangs on none."""
    armature, bones = obj.parent, getattr(obj.parent and obj.parent.data, "bones", None)
    if armature is None or bones is None or obj.parent_type != "BONE" or obj.parent_bone not in bones:
        return None
    bone = bones[obj.parent_bone]
    place = Matrix.Identity(4)
    if not bone.use_relative_parent:
        place = bone.matrix_local @ Matrix.Translation((0, bone.length, 0))
    return armature.matrix_world @ place @ obj.matrix_parent_inverse @ obj.matrix_basis


def topology(mesh: bpy.types.Mesh) -> str:
    """Return a text that is the same as long as the vertices and faces of a mesh are numbered and connected alike."""
    found = _topologies[-1] if _topologies else {}
    if mesh.session_uid not in found:
        digest = hashlib.blake2b(len(mesh.vertices).to_bytes(8, "little"), digest_size=16)
        for numbers in (_face_starts(mesh), corner_vertices(mesh)):
            digest.update(numbers.astype("<i4").tobytes())
        found[mesh.session_uid] = digest.hexdigest()
    return found[mesh.session_uid]


@contextmanager
def unedited() -> Iterator[None]:
    """Let the `topology` of each mesh be computed once at most, while no mesh is edited."""
    _topologies.append({})
    try:
        yield
    finally:
        _topologies.pop()


def position_digest(mesh: bpy.types.Mesh) -> str:
    """Return a text that is the same as long as no vertex of a mesh moves within its object."""
    return hashlib.blake2b(vertex_positions(mesh).astype("<f4").tobytes(), digest_size=16).hexdigest()


def vertex_positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Read the positions of a mesh's vertices, in the object's space, (n, 3)."""
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    if not _read_stored(mesh, "position", "vector", positions):
        mesh.vertices.foreach_get("co", positions)
    return positions.reshape(-1, 3)


def corner_vertices(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Read the vertex of each corner of a mesh's faces, (l,)."""
    corners = np.empty(len(mesh.loops), np.int32)
    if not _read_stored(mesh, ".corner_vert", "value", corners):
        mesh.loops.foreach_get("vertex_index", corners)
    return corners


def _read_stored(mesh: bpy.types.Mesh, name: str, member: str, values: NDArray[Any]) -> bool:
    """Read an attribute that Blender keeps a mesh itself in, which is 50 to 200 times faster; false in Edit Mode."""
    attribute: Any = mesh.attributes.get(name)
    if attribute is None or len(attribute.data) * (3 if member == "vector" else 1) != len(values):
        return False
    attribute.data.foreach_get(member, values)
    return True


def face_corner_counts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Read how many corners each face of a mesh has, (f,)."""
    return np.diff(_face_starts(mesh), append=np.int32(len(mesh.loops)))


def _face_starts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Read the first corner of each face of a mesh, (f,)."""
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return starts


@contextmanager
def _shown_mesh(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, *, use_modifiers: bool
) -> Iterator[bpy.types.Mesh]:
    """Lend the object's own mesh or the evaluated one, which must have the same vertices."""
    original = mesh_of(obj)
    if not use_modifiers:
        yield original
        return
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        if len(mesh.vertices) != len(original.vertices):
            raise ObjectError(_modifier_message(obj, len(original.vertices), len(mesh.vertices)))
        yield mesh
    finally:
        evaluated.to_mesh_clear()


@contextmanager
def without_modifiers(
    context: bpy.types.Context, objects: Sequence[bpy.types.Object], are_off: Callable[[str], bool]
) -> Iterator[None]:
    """Have modifiers of such types switched off as `are_off` tells, and on again in the end."""
    layer = view_layer_of(context)
    every = [modifier for obj in objects for modifier in obj.modifiers]
    off = [one for one in every if are_off(one.type) and one.show_viewport]
    for modifier in off:
        modifier.show_viewport = False
    layer.update()
    try:
        yield
    finally:
        for modifier in off:
            modifier.show_viewport = True
        layer.update()


def _modifier_message(obj: bpy.types.Object, before: int, after: int) -> str:
    """Say which modifiers stand between the evaluated mesh and the one that is written to."""
    active = [modifier for modifier in obj.modifiers if modifier.show_viewport]
    culprits = [modifier for modifier in active if modifier.type in TOPOLOGY_MODIFIERS] or active
    names = ", ".join(f'"{modifier.name}"' for modifier in culprits)
    return (
        f'The modifiers of "{obj.name}" change its vertices from {before} to {after} ({names}). '
        "Apply or disable these modifiers, or turn Use Modifiers off."
    )


def add_vertex_group(
    obj: bpy.types.Object, name: str, vertices: NDArray[np.int64], weights: NDArray[np.float64]
) -> None:
    """Add a vertex group with a few weighted vertices."""
    group = obj.vertex_groups.new(name=name)
    for vertex, weight in zip(vertices.tolist(), weights.tolist(), strict=True):
        group.add([vertex], weight, "REPLACE")


def add_colors(mesh: bpy.types.Mesh, name: str, colors: NDArray[np.float32]) -> None:
    """Add a color attribute with a linear colour (n, 4) per vertex."""
    attribute: Any = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.ascontiguousarray(colors, np.float32).ravel())
