# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of carried motion look at: curves of actions, how far one body is from another, and what must stay."""

import bpy
import numpy as np

from tests.addon.characters import posed_vertices


def curves_of(action):
    """Data path and index -> curve, in any version."""
    if hasattr(action, "slots"):
        bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
        return {(curve.data_path, curve.array_index): curve for bag in bags for curve in bag.fcurves}
    return {(curve.data_path, curve.array_index): curve for curve in action.fcurves}


def worst(source, target, frames):
    """Mean distance of the target's vertices from the source's, in the worst of some frames, by the height."""
    errors = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        errors.append(np.linalg.norm(posed_vertices(source) - posed_vertices(target), axis=1).mean())
    return max(errors) / 1.8


def snapshot(target):
    """What must stay as it is after a refusal."""
    return (
        sorted(bpy.data.actions.keys()),
        [list(bone.matrix_basis.to_quaternion()) for bone in target.pose.bones],
        target.animation_data and target.animation_data.action,
        len(bpy.context.scene.hiermatch_bone_pairs),
    )
