# SPDX-License-Identifier: GPL-3.0-or-later
"""Typed access to the context of an operator or panel.

Blender's own types call these optional, because a context may lack them in places where no operator runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from idprop.types import IDPropertyGroup

if TYPE_CHECKING:
    from collections.abc import Iterable

    import bpy


def view_layer_of(context: bpy.types.Context) -> bpy.types.ViewLayer:
    """Return the view layer."""
    return cast("bpy.types.ViewLayer", context.view_layer)


def window_manager_of(context: bpy.types.Context) -> bpy.types.WindowManager:
    """Return the window manager."""
    return cast("bpy.types.WindowManager", context.window_manager)


def open_collections(
    context: bpy.types.Context, collections: Iterable[bpy.types.Collection]
) -> list[bpy.types.Collection]:
    """Return those of some collections that objects can be put into; if there are none, the scene's own.

    Those of other files and overrides of such are closed, also if what is in them was made local.
    """
    found = [one for one in collections if one.library is None and one.override_library is None]
    return found or [cast("bpy.types.Scene", context.scene).collection]


def layout_of(owner: bpy.types.Panel | bpy.types.Menu | bpy.types.Operator) -> bpy.types.UILayout:
    """Return the layout of something that is being drawn."""
    return cast("bpy.types.UILayout", owner.layout)


def options_layout(owner: bpy.types.Panel | bpy.types.Operator) -> bpy.types.UILayout:
    """Return it for options: with names before the values, and nothing to animate them by."""
    layout = layout_of(owner)
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def mesh_of(obj: bpy.types.Object) -> bpy.types.Mesh:
    """Return the mesh data of a mesh object."""
    return cast("bpy.types.Mesh", obj.data)


def group_of(owner: Any, name: str) -> Any:  # noqa: ANN401 - mappings of whatever is in them
    """Return a custom property that is a group of others; an empty one if there is none, or somebody else's."""
    found = owner.get(name)
    return found if isinstance(found, IDPropertyGroup) else {}
