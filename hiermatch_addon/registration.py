# SPDX-License-Identifier: GPL-3.0-or-later
"""All that is registered with Blender, in order; unregistering is the same backwards."""

from __future__ import annotations

from typing import Any, Final

import bpy

from .freshness import start_watching, stop_watching
from .operators.cancel import HIERMATCH_OT_cancel
from .operators.clear import HIERMATCH_OT_clear
from .operators.demo import HIERMATCH_OT_add_demo_pair
from .operators.flip import HIERMATCH_OT_flip
from .operators.match import HIERMATCH_OT_match
from .operators.swap import HIERMATCH_OT_swap
from .operators.use_setup import HIERMATCH_OT_use_setup
from .panels import HIERMATCH_PT_match
from .properties import HIERMATCH_PG_progress, HIERMATCH_PG_scene, HIERMATCH_PG_summary

__all__ = ["CLASSES", "register", "unregister"]

CLASSES: Final[tuple[type[Any], ...]] = (
    HIERMATCH_PG_summary,
    HIERMATCH_PG_scene,
    HIERMATCH_PG_progress,
    HIERMATCH_OT_match,
    HIERMATCH_OT_cancel,
    HIERMATCH_OT_use_setup,
    HIERMATCH_OT_flip,
    HIERMATCH_OT_swap,
    HIERMATCH_OT_clear,
    HIERMATCH_OT_add_demo_pair,
    HIERMATCH_PT_match,
)
"""Property groups before what contains them."""

_ATTACHMENTS: Final[tuple[tuple[type[Any], type[Any]], ...]] = (
    (bpy.types.Scene, HIERMATCH_PG_scene),
    (bpy.types.WindowManager, HIERMATCH_PG_progress),
)
"""Each owner gets a property `hiermatch` of the group."""


def register() -> None:
    """Register all classes and attach the property groups to their owners."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    properties: Any = bpy.props
    for owner, group in _ATTACHMENTS:
        owner.hiermatch = properties.PointerProperty(name="HierMatch", description=group.__doc__, type=group)
    start_watching()


def unregister() -> None:
    """Undo `register`."""
    stop_watching()
    for owner, _ in reversed(_ATTACHMENTS):
        del owner.hiermatch
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
