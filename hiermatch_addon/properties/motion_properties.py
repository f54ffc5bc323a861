# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""The scene's properties for motion: the pairs of bones, and the options of carrying motion over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

__all__ = ["HIERMATCH_PG_bone_pair", "HIERMATCH_PG_motion", "MotionOptions", "bone_pairs_of", "motion_of"]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


def _is_armature(_owner: bpy.types.PropertyGroup, obj: bpy.types.Object) -> bool:
    return obj.type == "ARMATURE"


def _is_rigged(_owner: bpy.types.PropertyGroup, obj: bpy.types.Object) -> bool:
    return obj.type in {"ARMATURE", "MESH"}


def _unsee(row: Any, _context: bpy.types.Context) -> None:  # noqa: ANN401 - a row of the table
    """Forget what was seen on the surface of other bones than the row names now."""
    row.is_seen = False


class HIERMATCH_PG_bone_pair(bpy.types.PropertyGroup):
    """A pair of bones: a row of the table of two armatures."""

    source: _props.StringProperty(name="Source Bone", description="Bone of the source; empty for none", update=_unsee)
    target: _props.StringProperty(
        name="Target Bone", description="Bone of the target that stands for it", update=_unsee
    )
    score: _props.FloatProperty(
        name="Score", description="How well the two agree, from 0 to 1", min=0, max=1, default=1
    )
    locked: _props.BoolProperty(
        name="Lock", description="Keep this row when bones are paired again; without a source, the bone stays alone"
    )
    source_rig: _props.PointerProperty(
        name="Source Rig", description="Armature of the source", type=bpy.types.Object, poll=_is_armature
    )
    target_rig: _props.PointerProperty(
        name="Target Rig", description="Armature of the target", type=bpy.types.Object, poll=_is_armature
    )
    turn: _props.FloatVectorProperty(
        name="Turn",
        description="How the target's surface is turned against the source's at rest, in the spaces of the armatures",
        size=4,
        subtype="QUATERNION",
        default=(1, 0, 0, 0),
    )
    place: _props.FloatVectorProperty(
        name="Place", description="Where the head of the source bone lies in the target, in the target armature's space"
    )
    upright: _props.FloatVectorProperty(
        name="Standing",
        description="How the target stands, turned against the source, in the spaces of the armatures",
        size=4,
        subtype="QUATERNION",
        default=(1, 0, 0, 0),
    )
    is_seen: _props.BoolProperty(
        name="Seen", description="Whether turn and place were seen on the surface; a row made by hand has none"
    )


class MotionOptions:
    """How motion is carried over, for whatever class of Blender's inherits from it."""

    __annotations__ = {
        "keying": _props.EnumProperty(
            name="Keys",
            description="At which frames the new action gets keys",
            items=[
                ("AUTO", "Automatic", "At the source's keys if these are few, else reduced ones"),
                ("SOURCE", "As the Source", "At the keys of the source's bones, with their interpolation"),
                ("REDUCED", "Reduced", "As few as keep the motion within the Tolerance"),
                ("ALL", "Every Frame", "At every frame"),
            ],
            default="AUTO",
        ),
        "tolerance": _props.FloatProperty(
            name="Tolerance",
            description="By how much reduced keys may change a rotation",
            subtype="ANGLE",
            min=0,
            max=0.5,
            default=0.0035,
        ),
        "keep_feet": _props.BoolProperty(
            name="Keep Feet on Ground",
            description="Where a foot stands in the source, let it stand in the target: the leg is bent for it. All "
            "frames are computed then",
        ),
        "keep_hands": _props.BoolProperty(
            name="Keep Hands on Body",
            description="Where a hand touches the body or the other hand in the source, bend the target's arm so that "
            "it does so too. All frames are computed then",
        ),
        "stride": _props.FloatProperty(
            name="Stride",
            description="How long the way along the ground is; 1 fits the length of the target's legs",
            min=0,
            soft_max=3,
            default=1,
        ),
        "in_place": _props.BoolProperty(
            name="In Place", description="Take out the way from the first to the last frame, for walk cycles"
        ),
    }

    if TYPE_CHECKING:
        keying: str
        tolerance: float
        keep_feet: bool
        keep_hands: bool
        stride: float
        in_place: bool


class HIERMATCH_PG_motion(MotionOptions, bpy.types.PropertyGroup):
    """The state of the panel for motion on a scene."""

    source: _props.PointerProperty(
        name="Source",
        description="Armature that has the motion, or a mesh that it moves",
        type=bpy.types.Object,
        poll=_is_rigged,
    )
    target: _props.PointerProperty(
        name="Target",
        description="Armature that is to have it, or a mesh that it moves",
        type=bpy.types.Object,
        poll=_is_rigged,
    )
    index: _props.IntProperty(name="Pair", description="The row of the table of bones that is active", min=0)
    actions: _props.EnumProperty(
        name="Actions",
        description="Which actions of the source are carried over",
        items=[
            ("ACTIVE", "Active", "The one that the source plays"),
            ("ALL", "All", "All actions of the file that move bones of the source"),
        ],
        default="ACTIVE",
    )
    report: _props.StringProperty(name="Report", description="What became of it, one sentence per line")


def motion_of(context: bpy.types.Context) -> HIERMATCH_PG_motion:
    """Return the state of the panel for motion on the scene."""
    return cast("Any", context.scene).hiermatch_motion


def bone_pairs_of(scene: bpy.types.Scene) -> Any:  # noqa: ANN401 - a collection of Blender's
    """Return the table of pairs of bones on a scene, of all armatures."""
    return cast("Any", scene).hiermatch_bone_pairs
