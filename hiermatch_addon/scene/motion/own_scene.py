# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that the copy of an armature is alone in for a while: Blender evaluates that, and nothing that it moves."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np

from ..armatures import armature_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from mathutils import Matrix
    from numpy.typing import NDArray


class OwnScene:
    """A scene with the copy of an armature, and how that stands in it.

    Attributes
    ----------
    armature : bpy.types.Object
        The copy, which plays no action and hangs on what the original hangs on.  Whatever is done with it, the original
        and what is shown of it stay as they are.
    """

    def __init__(self, armature: bpy.types.Object, scene: bpy.types.Scene) -> None:
        self.armature, self._scene, self._layer = armature, scene, scene.view_layers[0]
        self._bones: Any = None

    def update(self) -> None:
        """Let Blender evaluate what was changed."""
        self._layer.update()
        depsgraph = cast("bpy.types.Depsgraph", self._layer.depsgraph)
        self._bones = cast("Any", self.armature.evaluated_get(depsgraph)).pose.bones

    def go_to(self, frame: float) -> None:
        """Let Blender evaluate a frame, which may be between two."""
        self._scene.frame_set(int(np.floor(frame)), subframe=float(frame - np.floor(frame)))
        self.update()

    def place(self) -> Matrix:
        """Return where the armature is in the world."""
        depsgraph = cast("bpy.types.Depsgraph", self._layer.depsgraph)
        return self.armature.evaluated_get(depsgraph).matrix_world

    def matrix(self, name: str) -> Matrix:
        """Return where a bone is, in the armature's space."""
        return cast("Matrix", self._bones[name].matrix)

    def matrices(self) -> NDArray[np.float64]:
        """Return where all bones are, in the armature's space, (b, 4, 4)."""
        return np.array([bone.matrix for bone in self._bones], np.float64).reshape(-1, 4, 4)

    def places(self, names: Sequence[str]) -> NDArray[np.float64]:
        """Return where bones are, in the armature's space, without scale, (k, 4, 4)."""
        found = np.array([self.matrix(name) for name in names], np.float64).reshape(-1, 4, 4)
        found[:, :3, :3] /= np.maximum(np.linalg.norm(found[:, :3, :3], axis=1, keepdims=True), np.finfo(float).tiny)
        return found

    def basis(self, bone: bpy.types.PoseBone, matrix: Matrix) -> Matrix:
        """Return the transform of a bone with which it will be there, in the armature's space, if nothing holds it."""
        rest: Any = bone.bone
        above = {}
        if bone.parent is not None:
            above = {"parent_matrix": self.matrix(bone.parent.name), "parent_matrix_local": rest.parent.matrix_local}
        return cast("Matrix", rest.convert_local_to_pose(matrix, rest.matrix_local, **above, invert=True))


@contextmanager
def own_scene(armature: bpy.types.Object) -> Iterator[OwnScene]:
    """Put a copy of an armature into a scene of its own, at the frame that is shown, as long as that is needed.

    The meshes that the armature moves would take most of the time.
    """
    shown = cast("bpy.types.Scene", bpy.context.scene)
    scene, copy = bpy.data.scenes.new("HierMatch"), armature.copy()
    bones = armature_of(armature)
    posed = bones if bones.pose_position == "POSE" else bones.copy()  # else it would be at rest there, too
    try:
        if posed is not bones:
            posed.pose_position, copy.data = "POSE", posed
        scene.frame_current, scene.frame_subframe = shown.frame_current, shown.frame_subframe
        animation: Any = copy.animation_data or copy.animation_data_create()
        animation.use_tweak_mode = animation.use_nla = False
        animation.action = None
        copy.hide_viewport = False
        scene.collection.objects.link(copy)
        yield OwnScene(copy, scene)
    finally:
        bpy.data.objects.remove(copy)
        if posed is not bones:
            bpy.data.armatures.remove(posed)
        bpy.data.scenes.remove(scene)
