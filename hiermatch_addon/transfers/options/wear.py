# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of fitting clothes: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import settings_of

FITS = [
    ("AUTO", "Automatic", "Close to the skin it follows each form of it, far from it only the body as a whole"),
    ("TIGHT", "Tight", "It follows each form of the skin, such as tights or a second skin"),
    ("LOOSE", "Loose", "It keeps its own shape and hangs as it did, such as a coat or long hair"),
    ("RIGID", "Rigid", "It keeps its shape wholly and only grows, such as a helmet"),
    ("LEAVE", "Leave", "It is moved along with the body, but not pushed out of it"),
]
"""How an item can fit, as the engine names it."""


class HIERMATCH_PG_worn(bpy.types.PropertyGroup):
    """How an item is fitted to other bodies; it is kept on the item, and so goes along with it."""

    fit: bpy.props.EnumProperty(name="Fit", description="How the item follows the body", items=FITS, default="AUTO")
    find_rigid: bpy.props.BoolProperty(
        name="Find Rigid Parts",
        description="Keep small solid parts as they are, such as buttons, buckles and glasses. Others can be named by "
        'a vertex group called "Rigid"',
        default=True,
    )


@dataclass(frozen=True)
class WearSettings:
    """How clothes are fitted to another body.

    Attributes
    ----------
    items : tuple of str
        Names of the items.
    result : str
        "OBJECT" for fitted copies, or "KEY" for a shape key on each item itself.
    clearance : float
        Least distance from the skin, in units of the scene.
    weights : str
        "AUTO", "OWN" or "SKIN".
    limit : int
        How many bones may move a vertex; 0 for any number.
    normalise : bool
        Whether the weights of bones sum to one.
    fit_rig : bool
        Whether a body without an armature gets the source's, fitted.
    hide : str
        What becomes of the body below: "NONE", "KEY" or "MASK".
    colors : bool
        Whether color attributes show what was done.
    poses : bool
        Whether weights are mended, and items lifted, where the body pokes through in test poses.
    keys : bool
        Whether they get the other body's shape keys that move it below them.
    """

    items: tuple[str, ...] = ()
    result: str = "OBJECT"
    clearance: float = 0.0
    weights: str = "AUTO"
    limit: int = 0
    normalise: bool = True
    fit_rig: bool = True
    hide: str = "NONE"
    colors: bool = False
    poses: bool = True
    keys: bool = True


class WearOptions:
    """The options of clothes, for whatever class of Blender's inherits from it."""

    wear_result: bpy.props.EnumProperty(
        name="Result",
        description="What is made",
        items=[
            ("OBJECT", "Fitted Copies", "A copy of each item, in a collection of its own"),
            ("KEY", "Shape Key", "A shape key on each item that moves it to the other body"),
        ],
        default="OBJECT",
    )
    wear_clearance: bpy.props.FloatProperty(
        name="Clearance",
        description="Least distance from the skin. With 0 it is what the items had on their own body, in the size "
        "of the other",
        default=0.0,
        min=0.0,
        soft_max=0.05,
        precision=4,
        subtype="DISTANCE",
    )
    wear_weights: bpy.props.EnumProperty(
        name="Weights",
        description="Which weights the fitted items get",
        items=[
            ("AUTO", "Automatic", "Their own, if the other body's rig has these bones, or else those of its skin"),
            ("OWN", "Own", "Their own, whatever bones the other body has"),
            ("SKIN", "From the Skin", "Those of the other body's skin, from where the items lie on it"),
        ],
        default="AUTO",
    )
    wear_limit: bpy.props.IntProperty(
        name="Limit",
        description="How many bones may move a vertex: the smallest weights go. 0 for any number",
        default=0,
        min=0,
        max=32,
    )
    wear_normalise: bpy.props.BoolProperty(
        name="Normalize",
        description="Let the weights of all bones sum to one at each vertex. Locked groups keep theirs",
        default=True,
    )
    wear_poses: bpy.props.BoolProperty(
        name="Mend in Poses",
        description="Bend each joint of the other body's rig, and where its skin pokes through an item then, bring "
        "the weights there closer to those of the skin, and lift the item a little",
        default=True,
    )
    wear_keys: bpy.props.BoolProperty(
        name="Follow Shape Keys",
        description="Give the fitted items the other body's shape keys that move it below them, driven by its own: "
        "they follow a wide belly or a squat",
        default=True,
    )
    wear_fit_rig: bpy.props.BoolProperty(
        name="Fit Rig",
        description="If the other body has no armature, give it that of the first, with its weights, as Retarget "
        "does, so that body and clothes move",
        default=True,
    )
    wear_hide: bpy.props.EnumProperty(
        name="Body Below",
        description="What becomes of the body where clothes cover it",
        items=[
            ("NONE", "As It Is", "It is left as it is"),
            ("KEY", "Shrink Key", "It gets a shape key that draws it in below clothes"),
            ("MASK", "Mask", "It gets a Mask modifier with a vertex group that hides it below clothes"),
        ],
        default="NONE",
    )
    wear_colors: bpy.props.BoolProperty(
        name="Show Fit",
        description="Write color attributes that show how far each vertex is from the skin, how far it was pushed, "
        "and where it is uncertain",
        default=False,
    )


def wear_settings(options: WearOptions, items: tuple[str, ...]) -> WearSettings:
    """Make the settings of the options for some items, given by name."""
    return settings_of(WearSettings, options, "wear_", items=items)
