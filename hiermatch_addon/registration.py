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
from .operators import (
    answer,
    cancel,
    clear,
    demo,
    export_match,
    flip,
    forget_shapes,
    import_match,
    match,
    refine,
    show,
    swap,
    use_setup,
)
from .operators.carrying import fit_my_rig, symmetrise, transfer_paired_weights, transfers, wear
from .operators.checking import before_after, bend_joints, show_fit
from .operators.motion import bone_pair_files, edit_bone_pairs, pair_bones, rename_bones, retarget_action
from .operators.steering import (
    add_landmark,
    edit_landmarks,
    edit_pairs,
    guide_me,
    landmark_files,
    mirror_landmarks,
    pick_landmarks,
)
from .operators.steering.landmark_clicks import LandmarkClicks
from .overlay import hover
from .overlay.drawing import start_overlay, stop_overlay
from .panels import answer_menu, match_panels, motion_panels, preset_menu, retarget_panels, steering_panels, wear_panel
from .panels.preset_menu import register_presets, unregister_presets
from .properties import bone_pairs, preferences, properties, steering_properties
from .properties.freshness import start_watching, stop_watching
from .properties.viewport_shading import start_following, stop_following
from .transfers import retarget_properties
from .transfers.options import wear as wear_options

CLASSES: Final[tuple[type[Any], ...]] = (
    properties.HIERMATCH_PG_summary,
    properties.HIERMATCH_PG_scene,
    properties.HIERMATCH_PG_progress,
    preferences.HIERMATCH_AP_preferences,
    match.HIERMATCH_OT_match,
    cancel.HIERMATCH_OT_cancel,
    answer.HIERMATCH_OT_answer,
    forget_shapes.HIERMATCH_OT_forget_shapes,
    use_setup.HIERMATCH_OT_use_setup,
    flip.HIERMATCH_OT_flip,
    answer_menu.HIERMATCH_MT_answers,
    swap.HIERMATCH_OT_swap,
    clear.HIERMATCH_OT_clear,
    export_match.HIERMATCH_OT_export_match,
    import_match.HIERMATCH_OT_import_match,
    demo.HIERMATCH_OT_add_demo_pair,
    steering_properties.HIERMATCH_PG_landmark,
    steering_properties.HIERMATCH_PG_pair,
    steering_properties.HIERMATCH_PG_steering,
    add_landmark.HIERMATCH_OT_add_landmark,
    pick_landmarks.HIERMATCH_OT_pick_landmarks,
    guide_me.HIERMATCH_OT_guide_me,
    edit_landmarks.HIERMATCH_OT_remove_landmark,
    edit_landmarks.HIERMATCH_OT_switch_landmark,
    edit_landmarks.HIERMATCH_OT_select_landmark,
    edit_landmarks.HIERMATCH_OT_clear_landmarks,
    mirror_landmarks.HIERMATCH_OT_mirror_landmarks,
    landmark_files.HIERMATCH_OT_save_landmarks,
    landmark_files.HIERMATCH_OT_load_landmarks,
    edit_pairs.HIERMATCH_OT_select_pair,
    edit_pairs.HIERMATCH_OT_lock_pair,
    edit_pairs.HIERMATCH_OT_remove_pair,
    refine.HIERMATCH_OT_refine,
    show.HIERMATCH_OT_show,
    show.HIERMATCH_OT_write_regions,
    retarget_properties.HIERMATCH_PG_report,
    retarget_properties.HIERMATCH_PG_retarget,
    wear_options.HIERMATCH_PG_worn,
    transfers.HIERMATCH_OT_retarget,
    transfers.HIERMATCH_OT_fit_rig,
    fit_my_rig.HIERMATCH_OT_fit_my_rig,
    transfers.HIERMATCH_OT_transfer_weights,
    transfers.HIERMATCH_OT_transfer_shape_keys,
    transfers.HIERMATCH_OT_transfer_uvs,
    transfers.HIERMATCH_OT_transfer_attributes,
    transfers.HIERMATCH_OT_wrap,
    wear.HIERMATCH_OT_wear,
    symmetrise.HIERMATCH_OT_symmetrise,
    bend_joints.HIERMATCH_OT_test_poses,
    before_after.HIERMATCH_OT_before_after,
    show_fit.HIERMATCH_OT_show_fit,
    bone_pairs.HIERMATCH_PG_bone_pair,
    pair_bones.HIERMATCH_OT_pair_bones,
    rename_bones.HIERMATCH_OT_rename_bones,
    retarget_action.HIERMATCH_OT_retarget_action,
    retarget_action.HIERMATCH_OT_retarget_pose,
    edit_bone_pairs.HIERMATCH_OT_add_bone_pair,
    edit_bone_pairs.HIERMATCH_OT_remove_bone_pair,
    edit_bone_pairs.HIERMATCH_OT_clear_bone_pairs,
    bone_pair_files.HIERMATCH_OT_export_bone_pairs,
    bone_pair_files.HIERMATCH_OT_import_bone_pairs,
    transfer_paired_weights.HIERMATCH_OT_transfer_paired_weights,
    motion_panels.HIERMATCH_UL_bone_pairs,
    steering_panels.HIERMATCH_UL_landmarks,
    steering_panels.HIERMATCH_UL_pairs,
    preset_menu.HIERMATCH_OT_add_preset,
    preset_menu.HIERMATCH_PT_presets,
    match_panels.HIERMATCH_PT_match,
    steering_panels.HIERMATCH_PT_overlay,
    steering_panels.HIERMATCH_PT_landmarks,
    steering_panels.HIERMATCH_PT_pairs,
    retarget_panels.HIERMATCH_PT_retarget,
    motion_panels.HIERMATCH_PT_motion,
    wear_panel.HIERMATCH_PT_wear,
    retarget_panels.HIERMATCH_PT_symmetry,
    hover.HIERMATCH_GT_hover,
    hover.HIERMATCH_GGT_hover,
)
"""Property groups before what contains them."""

_ATTACHMENTS: Final[tuple[tuple[type[Any], str, type[Any]], ...]] = (
    (bpy.types.Scene, "hiermatch", properties.HIERMATCH_PG_scene),
    (bpy.types.Scene, "hiermatch_retarget", retarget_properties.HIERMATCH_PG_retarget),
    (bpy.types.Scene, "hiermatch_steering", steering_properties.HIERMATCH_PG_steering),
    (bpy.types.Object, "hiermatch_wear", wear_options.HIERMATCH_PG_worn),
    (bpy.types.WindowManager, "hiermatch", properties.HIERMATCH_PG_progress),
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
    props: Any = bpy.props
    with ExitStack() as undo:
        register_translations()
        undo.callback(unregister_translations)
        for cls in CLASSES:
            use_context(cls)
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        for owner, name, group in _ATTACHMENTS:
            setattr(owner, name, props.PointerProperty(name="HierMatch", description=group.__doc__, type=group))
            undo.callback(delattr, owner, name)
        table = props.CollectionProperty(
            name="Bone Pairs",
            description="Which bones of two armatures belong together",
            type=bone_pairs.HIERMATCH_PG_bone_pair,
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
