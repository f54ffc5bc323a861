# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Presets of all options, with Blender's own preset system.

A preset is a script that Blender runs.  Those that come with the extension lie in ``presets/hiermatch``, and those
that a user saves where Blender keeps presets.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..properties.panel_state import state_of
from ..properties.properties import OPTION_NAMES
from ..transfers.options.motion import MotionOptions
from ..transfers.options.my_rig import MyRigOptions
from ..transfers.options.retarget import KINDS, option_names
from ..transfers.options.symmetrise import SymmetriseOptions
from ..transfers.options.wear import WearOptions
from ..transfers.options.wrap import WrapOptions
from ..transfers.retarget_properties import retarget_of

_utils: Any = bpy.utils  # of which they do not know all

_FOLDER: Final = str(Path(__file__).parents[1])
"""Where Blender finds the built-in presets, below ``presets``."""

_SUBFOLDER: Final = "hiermatch"

_OF_A_PAIR: Final = ("prefix", "exclude_source", "exclude_target", "action", "rig")
"""Options that belong to two meshes, and not to a way of working."""

MATCH_NAMES: Final = tuple(name for name in OPTION_NAMES if name not in _OF_A_PAIR)
"""The options of a match that a preset holds."""

_OPTIONS: Final = (*KINDS.values(), MyRigOptions, WrapOptions, WearOptions, SymmetriseOptions, MotionOptions)

RETARGET_NAMES: Final = (
    *KINDS,
    *(name for kind in _OPTIONS for name in option_names(kind) if name not in _OF_A_PAIR),
    "refine",
)
"""The options of retargeting that a preset holds."""


class HIERMATCH_PT_presets(PresetPanel, bpy.types.Panel):
    """The menu of presets."""

    bl_label = "HierMatch Presets"
    preset_subdir = _SUBFOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = "hiermatch.add_preset"

    @staticmethod
    def reset_cb(context: bpy.types.Context, _filepath: str) -> None:
        """Set all options to their defaults, from which a preset then departs."""
        for owner, names in ((state_of(context), MATCH_NAMES), (retarget_of(context), RETARGET_NAMES)):
            for name in names:
                owner.property_unset(name)


class HIERMATCH_OT_add_preset(AddPresetBase, bpy.types.Operator):  # type: ignore[misc]  # stubs without types
    """Save all options as a preset, or remove one that was saved."""

    bl_idname = "hiermatch.add_preset"
    bl_label = "Add HierMatch Preset"
    bl_description = "Save the options of Match and Retarget as a preset, or remove one that was saved"
    preset_menu = "HIERMATCH_PT_presets"
    preset_subdir = _SUBFOLDER
    # Whole paths: where Blender runs on a newer Python than it was made for, it cannot see names that it defines.
    preset_defines: Final[list[str]] = []
    preset_values: Final = [
        *(f"bpy.context.scene.hiermatch.{name}" for name in MATCH_NAMES),
        *(f"bpy.context.scene.hiermatch_retarget.{name}" for name in RETARGET_NAMES),
    ]

    name: bpy.props.StringProperty(
        name="Name", description="Name of the preset, of which its file is named", maxlen=64, options={"SKIP_SAVE"}
    )
    remove_name: bpy.props.BoolProperty(
        name="Remove by Name",
        description="Remove the preset of that name instead of saving one",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    remove_active: bpy.props.BoolProperty(
        name="Remove Active",
        description="Remove the preset that was chosen last instead of saving one",
        options={"HIDDEN", "SKIP_SAVE"},
    )


def register_presets() -> None:
    """Let Blender find the built-in presets."""
    _utils.register_preset_path(_FOLDER)


def unregister_presets() -> None:
    """Undo `register_presets`."""
    _utils.unregister_preset_path(_FOLDER)
