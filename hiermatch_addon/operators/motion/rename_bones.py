# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Give bones the names of a standard, or those of another rig."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ...common.access import options_layout, window_manager_of
from ...common.errors import ObjectError
from ...common.phrases import counted
from ...common.translated_text import translated
from ...jobs.running import Startable
from ...scene.motion.rigs import check_armature, rig_of
from ...transfers.motion.bone_names import names_by_source, names_by_table, rename_bones
from ..checking.rig_operator import meant_target
from ..pair_operator import pick_sides
from ..reported_errors import reporting_errors

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

_STANDARDS = [
    ("VRM", "VRM", "Names of the humanoid bones of VRM 1.0, such as leftUpperArm"),
    ("MIXAMO", "Mixamo", "Names of Mixamo, such as mixamorig:LeftArm"),
    ("UNREAL", "Unreal", "Names of Unreal's mannequin, such as upperarm_l"),
    ("RIGIFY", "Rigify", "Names of the bones of Rigify that deform, such as DEF-upper_arm.L"),
]


class HIERMATCH_OT_rename_bones(Startable, bpy.types.Operator):
    """Rename bones."""

    bl_idname = "hiermatch.rename_bones"
    bl_label = "Rename Bones"
    bl_description = (
        "Give the bones of the target's rig the names of a standard, or of the source's bones. Vertex groups, actions, "
        "constraints and drivers follow"
    )
    modes = ("OBJECT", "POSE")

    target: bpy.props.StringProperty(
        name="Target",
        description="Name of an armature, or of what it moves; if empty, the one picked in the panel or else the "
        "active object",
        options={"SKIP_SAVE"},
    )
    source: bpy.props.StringProperty(
        name="Source",
        description="Name of the armature whose names are taken over, or of what it moves; if empty, the one picked "
        "in the panel",
        options={"SKIP_SAVE"},
    )
    names: bpy.props.EnumProperty(
        name="Names",
        description="What the bones are to be called",
        items=[
            *_STANDARDS,
            (
                "SOURCE",
                "As the Source",
                "The names of the source's bones with which they are paired, whatever they move",
            ),
        ],
        default="VRM",
    )
    known: bpy.props.EnumProperty(
        name="Known by",
        description="What tells which bone is which, for a standard",
        items=[
            ("JOINTS", "Joints", "Where the joints are, and what hangs on what. Names do not matter"),
            *_STANDARDS,
        ],
        default="JOINTS",
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Ask for the names, and by what the bones are known: after a refusal there would be nothing to adjust."""
        return window_manager_of(context).invoke_props_dialog(cast("Any", self))

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw what matters, as it is asked and when the operation is adjusted."""
        layout: Any = options_layout(self)
        layout.prop(self, "names")
        if self.names != "SOURCE":
            layout.prop(self, "known")

    @reporting_errors
    def execute(self, context: bpy.types.Context) -> set[OperatorReturnItems]:
        """Rename, and report."""
        scene = cast("bpy.types.Scene", context.scene)
        if self.names == "SOURCE":
            source, targets, _ = pick_sides(context, self.source, [self.target] if self.target else [])
            armature = rig_of(targets[0])
            names = names_by_source(scene, rig_of(source), armature)
        else:
            armature = rig_of(meant_target(context, self.target))
            names = names_by_table(armature, self.known, self.names)
        check_armature(armature, written=False)
        self._check_own(armature)
        count = rename_bones(scene, armature, names)
        kept = len(cast("bpy.types.Armature", armature.data).bones) - len(names)
        self.report({"INFO"}, translated(f'{counted(count, "bone")} of "{armature.name}" got another name'))
        if kept:
            self.report({"INFO"}, translated(f"{counted(kept, 'bone')} kept the name: there is none for it"))
        return {"FINISHED"}

    @staticmethod
    def _check_own(armature: bpy.types.Object) -> None:
        """Make sure that the bones may be renamed."""
        data = cast("bpy.types.Armature", armature.data)
        if data.library is not None or data.override_library is not None or armature.library is not None:
            raise ObjectError(
                f'The bones of "{armature.name}" are linked from another file and cannot be renamed here. Make it '
                "local first (Object > Relations > Make Local)."
            )
