# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of carrying attributes: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import names_in, settings_of


@dataclass(frozen=True)
class AttributeSettings:
    """Which attributes are carried over.

    Attributes
    ----------
    colors, values : bool
        Whether color attributes, and other attributes that somebody added, are carried.
    names : tuple of str
        If there are any, only attributes of these names are, of those two kinds.
    materials : bool
        Whether faces get materials.
    sharp, seams, creases : bool
        Whether sharp edges and flat faces, seams, and creases and bevel weights are carried.
    normals : bool
        Whether custom normals are, if the source has any.
    """

    colors: bool = True
    values: bool = True
    names: tuple[str, ...] = ()
    materials: bool = True
    sharp: bool = True
    seams: bool = False
    creases: bool = True
    normals: bool = True


class AttributeOptions:
    """The options of attributes, for whatever class of Blender's inherits from it."""

    attribute_colors: bpy.props.BoolProperty(
        name="Color Attributes",
        description="Carry color attributes over; those of the same name are replaced",
        default=True,
    )
    attribute_values: bpy.props.BoolProperty(
        name="Other Attributes",
        description="Carry over attributes of numbers, vectors and truth values that were added to the source",
        default=True,
    )
    attribute_names: bpy.props.StringProperty(
        name="Names",
        description="Names of the attributes to carry over, separated by commas; if empty, all",
    )
    attribute_materials: bpy.props.BoolProperty(
        name="Materials",
        description="Give each face the material of the source there; materials are added to the slots of the "
        "target unless they are there already",
        default=True,
    )
    attribute_sharp: bpy.props.BoolProperty(
        name="Sharp Edges",
        description="Mark the edges as sharp that follow sharp edges of the source, and shade faces flat where the "
        "source is, instead of what is marked on the target",
        default=True,
    )
    attribute_seams: bpy.props.BoolProperty(
        name="Seams",
        description="Mark the edges as seams that follow seams of the source, instead of those of the target. "
        "UV maps that are carried over bring their own",
        default=False,
    )
    attribute_creases: bpy.props.BoolProperty(
        name="Creases and Bevels",
        description="Carry creases and bevel weights over to the edges and vertices that follow those of the source",
        default=True,
    )
    attribute_normals: bpy.props.BoolProperty(
        name="Custom Normals",
        description="Carry over how the custom normals of the source deviate from its surface, if it has any",
        default=True,
    )


def attribute_settings(options: AttributeOptions) -> AttributeSettings:
    """Make the settings of the options."""
    return settings_of(AttributeSettings, options, "attribute_", names=names_in(options.attribute_names))
