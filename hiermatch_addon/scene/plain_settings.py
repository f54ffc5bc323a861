# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a modifier, of an object or of a curve, as a text that is another one once they were changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Collection

    import bpy

_SHOWN: Final = ("show_", "is_", "open_", "use_pin_to_last", "name", "type", "active")
"""What the names of those members of a modifier begin with that say nothing of what it does."""

_PLAIN: Final = frozenset({"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"})
"""Types of members that hold a value, and nothing that has members itself."""


def written_settings(modifier: bpy.types.Modifier | bpy.types.FModifier, without: Collection[str] = ()) -> str:
    """Write what is set on a modifier, but for some members."""
    names = [
        prop.identifier
        for prop in modifier.bl_rna.properties
        if prop.type in _PLAIN and not prop.is_readonly and not prop.identifier.startswith(_SHOWN)
    ]
    return repr({name: _plain(getattr(modifier, name)) for name in names if name not in without})


def _plain(value: Any) -> Any:  # noqa: ANN401 - whatever a modifier holds
    """Write a value so that what is equal looks alike."""
    if isinstance(value, set):
        return sorted(value)
    return value if isinstance(value, str) or not hasattr(value, "__len__") else list(value)
