# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of carrying UV layers: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import names_in, settings_of


@dataclass(frozen=True)
class UVSettings:
    """How UV layers are carried over.

    Attributes
    ----------
    choice : str
        Which layers: "ALL", "ACTIVE" or "NAMED".
    names : tuple of str
        Their names if they are chosen by name.
    seams : bool
        Whether the edges between islands are marked as seams.
    """

    choice: str = "ALL"
    names: tuple[str, ...] = ()
    seams: bool = True


class UVOptions:
    """The options of UV layers, for whatever class of Blender's inherits from it."""

    uv_layers: bpy.props.EnumProperty(
        name="UV Maps",
        description="Which UV maps of the source are carried over. Those of the same name are replaced",
        items=[
            ("ALL", "All", "All UV maps"),
            ("ACTIVE", "Active", "The active UV map"),
            ("NAMED", "By Name", "The UV maps that are named"),
        ],
        default="ALL",
    )
    uv_names: bpy.props.StringProperty(
        name="Names",
        description="Names of the UV maps to carry over, separated by commas",
    )
    uv_seams: bpy.props.BoolProperty(
        name="Mark Seams",
        description="Mark the edges between the islands of the active UV map as seams on the target, instead of "
        "the seams that it has",
        default=True,
    )


def uv_settings(options: UVOptions) -> UVSettings:
    """Make the settings of the options."""
    return settings_of(UVSettings, options, "uv_", choice=options.uv_layers, names=names_in(options.uv_names))
