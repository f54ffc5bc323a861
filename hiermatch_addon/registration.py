# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is registered with Blender, in order; unregistering is the same backwards."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any, Final

import bpy

from ..engine import close_helpers
from .command_line import register_command, unregister_command
from .common.access import window_manager_of
from .common.translations import register_translations, unregister_translations, use_context
from .jobs.job_operator import JobOperator
from .jobs.running import modal_operators
from .operators.answer import HIERMATCH_OT_answer
from .operators.cancel import HIERMATCH_OT_cancel
from .operators.carrying.fit_my_rig import HIERMATCH_OT_fit_my_rig
from .operators.carrying.fit_rig import HIERMATCH_OT_fit_rig
from .operators.carrying.retarget import HIERMATCH_OT_retarget
from .operators.carrying.symmetrise import HIERMATCH_OT_symmetrise
from .operators.carrying.transfer_attributes import HIERMATCH_OT_transfer_attributes
from .operators.carrying.transfer_paired_weights import HIERMATCH_OT_transfer_paired_weights
from .operators.carrying.transfer_shape_keys import HIERMATCH_OT_transfer_shape_keys
from .operators.carrying.transfer_uvs import HIERMATCH_OT_transfer_uvs
from .operators.carrying.transfer_weights import HIERMATCH_OT_transfer_weights
from .operators.carrying.wear import HIERMATCH_OT_wear
from .operators.carrying.wrap import HIERMATCH_OT_wrap
from .operators.checking.before_after import HIERMATCH_OT_before_after
from .operators.checking.bend_joints import HIERMATCH_OT_test_poses
from .operators.checking.show_fit import HIERMATCH_OT_show_fit
from .operators.clear import HIERMATCH_OT_clear
from .operators.demo import HIERMATCH_OT_add_demo_pair
from .operators.export_match import HIERMATCH_OT_export_match
from .operators.flip import HIERMATCH_OT_flip
from .operators.forget_shapes import HIERMATCH_OT_forget_shapes
from .operators.import_match import HIERMATCH_OT_import_match
from .operators.match import HIERMATCH_OT_match
from .operators.motion.bone_pair_files import HIERMATCH_OT_export_bone_pairs, HIERMATCH_OT_import_bone_pairs
from .operators.motion.edit_bone_pairs import (
    HIERMATCH_OT_add_bone_pair,
    HIERMATCH_OT_clear_bone_pairs,
    HIERMATCH_OT_remove_bone_pair,
)
from .operators.motion.pair_bones import HIERMATCH_OT_pair_bones
from .operators.motion.rename_bones import HIERMATCH_OT_rename_bones
from .operators.motion.retarget_action import HIERMATCH_OT_retarget_action, HIERMATCH_OT_retarget_pose
from .operators.refine import HIERMATCH_OT_refine
from .operators.show import HIERMATCH_OT_show, HIERMATCH_OT_write_regions
from .operators.steering.add_landmark import HIERMATCH_OT_add_landmark
from .operators.steering.edit_landmarks import (
    HIERMATCH_OT_clear_landmarks,
    HIERMATCH_OT_remove_landmark,
    HIERMATCH_OT_select_landmark,
    HIERMATCH_OT_switch_landmark,
)
from .operators.steering.edit_pairs import (
    HIERMATCH_OT_lock_pair,
    HIERMATCH_OT_remove_pair,
    HIERMATCH_OT_select_pair,
)
from .operators.steering.guide_me import HIERMATCH_OT_guide_me
from .operators.steering.landmark_clicks import LandmarkClicks
from .operators.steering.landmark_files import HIERMATCH_OT_load_landmarks, HIERMATCH_OT_save_landmarks
from .operators.steering.mirror_landmarks import HIERMATCH_OT_mirror_landmarks
from .operators.steering.pick_landmarks import HIERMATCH_OT_pick_landmarks
from .operators.swap import HIERMATCH_OT_swap
from .operators.use_setup import HIERMATCH_OT_use_setup
from .overlay.drawing import start_overlay, stop_overlay
from .overlay.hover import HIERMATCH_GGT_hover, HIERMATCH_GT_hover
from .panels.answer_menu import HIERMATCH_MT_answers
from .panels.match_panels import HIERMATCH_PT_match
from .panels.motion_panels import HIERMATCH_PT_motion, HIERMATCH_UL_bone_pairs
from .panels.preset_menu import HIERMATCH_OT_add_preset, HIERMATCH_PT_presets, register_presets, unregister_presets
from .panels.retarget_panels import HIERMATCH_PT_retarget, HIERMATCH_PT_symmetry
from .panels.steering_panels import (
    HIERMATCH_PT_landmarks,
    HIERMATCH_PT_overlay,
    HIERMATCH_PT_pairs,
    HIERMATCH_UL_landmarks,
    HIERMATCH_UL_pairs,
)
from .panels.wear_panel import HIERMATCH_PT_wear
from .properties.bone_pairs import HIERMATCH_PG_bone_pair
from .properties.freshness import start_watching, stop_watching
from .properties.preferences import HIERMATCH_AP_preferences
from .properties.properties import HIERMATCH_PG_progress, HIERMATCH_PG_scene, HIERMATCH_PG_summary
from .properties.steering_properties import HIERMATCH_PG_landmark, HIERMATCH_PG_pair, HIERMATCH_PG_steering
from .properties.viewport_shading import start_following, stop_following
from .transfers.options.wear import HIERMATCH_PG_worn
from .transfers.retarget_properties import HIERMATCH_PG_report, HIERMATCH_PG_retarget

CLASSES: Final[tuple[type[Any], ...]] = (
    HIERMATCH_PG_summary,
    HIERMATCH_PG_scene,
    HIERMATCH_PG_progress,
    HIERMATCH_AP_preferences,
    HIERMATCH_OT_match,
    HIERMATCH_OT_cancel,
    HIERMATCH_OT_answer,
    HIERMATCH_OT_forget_shapes,
    HIERMATCH_OT_use_setup,
    HIERMATCH_OT_flip,
    HIERMATCH_MT_answers,
    HIERMATCH_OT_swap,
    HIERMATCH_OT_clear,
    HIERMATCH_OT_export_match,
    HIERMATCH_OT_import_match,
    HIERMATCH_OT_add_demo_pair,
    HIERMATCH_PG_landmark,
    HIERMATCH_PG_pair,
    HIERMATCH_PG_steering,
    HIERMATCH_OT_add_landmark,
    HIERMATCH_OT_pick_landmarks,
    HIERMATCH_OT_guide_me,
    HIERMATCH_OT_remove_landmark,
    HIERMATCH_OT_switch_landmark,
    HIERMATCH_OT_select_landmark,
    HIERMATCH_OT_clear_landmarks,
    HIERMATCH_OT_mirror_landmarks,
    HIERMATCH_OT_save_landmarks,
    HIERMATCH_OT_load_landmarks,
    HIERMATCH_OT_select_pair,
    HIERMATCH_OT_lock_pair,
    HIERMATCH_OT_remove_pair,
    HIERMATCH_OT_refine,
    HIERMATCH_OT_show,
    HIERMATCH_OT_write_regions,
    HIERMATCH_PG_report,
    HIERMATCH_PG_retarget,
    HIERMATCH_PG_worn,
    HIERMATCH_OT_retarget,
    HIERMATCH_OT_fit_rig,
    HIERMATCH_OT_fit_my_rig,
    HIERMATCH_OT_transfer_weights,
    HIERMATCH_OT_transfer_shape_keys,
    HIERMATCH_OT_transfer_uvs,
    HIERMATCH_OT_transfer_attributes,
    HIERMATCH_OT_wrap,
    HIERMATCH_OT_wear,
    HIERMATCH_OT_symmetrise,
    HIERMATCH_OT_test_poses,
    HIERMATCH_OT_before_after,
    HIERMATCH_OT_show_fit,
    HIERMATCH_PG_bone_pair,
    HIERMATCH_OT_pair_bones,
    HIERMATCH_OT_rename_bones,
    HIERMATCH_OT_retarget_action,
    HIERMATCH_OT_retarget_pose,
    HIERMATCH_OT_add_bone_pair,
    HIERMATCH_OT_remove_bone_pair,
    HIERMATCH_OT_clear_bone_pairs,
    HIERMATCH_OT_export_bone_pairs,
    HIERMATCH_OT_import_bone_pairs,
    HIERMATCH_OT_transfer_paired_weights,
    HIERMATCH_UL_bone_pairs,
    HIERMATCH_UL_landmarks,
    HIERMATCH_UL_pairs,
    HIERMATCH_OT_add_preset,
    HIERMATCH_PT_presets,
    HIERMATCH_PT_match,
    HIERMATCH_PT_overlay,
    HIERMATCH_PT_landmarks,
    HIERMATCH_PT_pairs,
    HIERMATCH_PT_retarget,
    HIERMATCH_PT_motion,
    HIERMATCH_PT_wear,
    HIERMATCH_PT_symmetry,
    HIERMATCH_GT_hover,
    HIERMATCH_GGT_hover,
)
"""Property groups before what contains them."""

_ATTACHMENTS: Final[tuple[tuple[type[Any], str, type[Any]], ...]] = (
    (bpy.types.Scene, "hiermatch", HIERMATCH_PG_scene),
    (bpy.types.Scene, "hiermatch_retarget", HIERMATCH_PG_retarget),
    (bpy.types.Scene, "hiermatch_steering", HIERMATCH_PG_steering),
    (bpy.types.Object, "hiermatch_wear", HIERMATCH_PG_worn),
    (bpy.types.WindowManager, "hiermatch", HIERMATCH_PG_progress),
)
"""Each owner gets a property of that name and group."""

_SERVICES: Final = (
    (register_presets, unregister_presets),
    (start_watching, stop_watching),
    (start_following, stop_following),
    (register_command, unregister_command),
    (start_overlay, stop_overlay),
)
"""What is begun when all classes are there, and what ends it, however far it has come."""

_TABLE: Final = "hiermatch_bone_pairs"
"""The scene's table of pairs of bones."""

_registered: Final = ExitStack()
"""What takes back all that `register` has done."""


def register() -> None:
    """Register all classes and attach the property groups to their owners: everything, or nothing if that fails."""
    properties: Any = bpy.props
    with ExitStack() as undo:
        register_translations()
        undo.callback(unregister_translations)
        for cls in CLASSES:
            use_context(cls)
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        for owner, name, group in _ATTACHMENTS:
            setattr(owner, name, properties.PointerProperty(name="HierMatch", description=group.__doc__, type=group))
            undo.callback(delattr, owner, name)
        table = properties.CollectionProperty(
            name="Bone Pairs", description="Which bones of two armatures belong together", type=HIERMATCH_PG_bone_pair
        )
        setattr(bpy.types.Scene, _TABLE, table)
        undo.callback(delattr, bpy.types.Scene, _TABLE)
        for start, stop in _SERVICES:
            undo.callback(stop)
            start()
        undo.callback(close_helpers)
        undo.callback(_end_modal)
        _registered.enter_context(undo.pop_all())


def unregister() -> None:
    """Undo `register`."""
    _registered.close()


def _end_modal() -> None:
    """End what works or waits for clicks in a window: Blender only drops it, and its timer and its texts stay."""
    context = bpy.context
    for window, operator in modal_operators(window_manager_of(context)):
        if isinstance(operator, (JobOperator, LandmarkClicks)):
            with context.temp_override(window=window):
                operator.cancel(context)
