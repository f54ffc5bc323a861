# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""Options of carrying weights: Blender's properties, and the plain settings that they make."""

from dataclasses import dataclass

import bpy

from .plain_settings import settings_of


@dataclass(frozen=True)
class WeightSettings:
    """How weights are carried over.

    Attributes
    ----------
    groups : str
        Which vertex groups: "ALL", "DEFORM", "SELECTED" or "ACTIVE".
    mode : str
        What becomes of weights that are there: "REPLACE" or "ADD".
    mix : float
        How much the carried weights count, 0 to 1.
    normalise : bool
        Whether the weights of bones sum to one at each vertex afterwards.
    limit : int
        How many bones may move a vertex; 0 for any number.
    clean : float
        Weights below this are dropped.
    fill : bool
        Whether vertices that the map tears away from their neighbours take the weights around them.
    alone : str
        What vertices without a counterpart get: "MAP", the weights of where the map has them; "FILL", those of the
        vertices around them that have one; "LEAVE", nothing new.
    rigid : bool
        Whether loose pieces move as one whose counterparts on the source do.
    rigid_group : str
        Name of the vertex group of the target that says which pieces do in any case, and which do not.
    mark : bool
        Whether a color attribute shows these vertices.
    prefix : str
        What the name of that attribute starts with.
    """

    groups: str = "ALL"
    mode: str = "REPLACE"
    mix: float = 1.0
    normalise: bool = True
    limit: int = 0
    clean: float = 0.001
    fill: bool = True
    alone: str = "MAP"
    rigid: bool = True
    rigid_group: str = "Rigid"
    mark: bool = False
    prefix: str = "HM"


class WeightOptions:
    """The options of weights, for whatever class of Blender's inherits from it."""

    weight_groups: bpy.props.EnumProperty(
        name="Vertex Groups",
        description="Which vertex groups of the source are carried over. Those that a match wrote never are",
        items=[
            ("ALL", "All", "All vertex groups"),
            ("DEFORM", "Deforming Bones", "The vertex groups of bones that deform"),
            ("SELECTED", "Selected Bones", "The vertex groups of the bones that are selected in the source's rig"),
            ("ACTIVE", "Active", "The active vertex group"),
        ],
        default="ALL",
    )
    weight_mode: bpy.props.EnumProperty(
        name="Mode",
        description="What becomes of the weights that the target has in these groups",
        items=[
            ("REPLACE", "Replace", "The carried weights take their place"),
            ("ADD", "Add", "The carried weights are added to them"),
        ],
        default="REPLACE",
    )
    weight_mix: bpy.props.FloatProperty(
        name="Mix Factor",
        description="How much the carried weights count against those that are there",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    weight_normalise: bpy.props.BoolProperty(
        name="Normalize",
        description="Let the weights of all bones sum to one at each vertex. Locked groups keep theirs. If only "
        "some groups are carried, the others of the target give way to them",
        default=True,
    )
    weight_limit: bpy.props.IntProperty(
        name="Limit",
        description="How many bones may move a vertex: the smallest weights go, and fade before they do. 0 for any "
        "number",
        default=0,
        min=0,
        max=32,
    )
    weight_clean: bpy.props.FloatProperty(
        name="Clean",
        description="Weights below this are dropped, but for the largest of each vertex",
        default=0.001,
        min=0.0,
        max=0.5,
        precision=3,
    )
    weight_fill: bpy.props.BoolProperty(
        name="Fill",
        description="Where the map tears vertices away from their neighbors, take the weights from around them "
        "along the surface",
        default=True,
    )
    weight_alone: bpy.props.EnumProperty(
        name="No Counterpart",
        description="What vertices get that have no counterpart on the source, as Show > Overlap tells: where the "
        "target shows more of a body than the source",
        items=[
            ("MAP", "Follow the Map", "The weights of the nearest place that the map leads to"),
            ("FILL", "Fill", "The weights of the vertices around them that have a counterpart"),
            ("LEAVE", "Leave Out", "Their weights stay as they are"),
        ],
        default="MAP",
    )
    weight_rigid: bpy.props.BoolProperty(
        name="Rigid Pieces",
        description="Let loose pieces move as one, such as eyes, teeth, buckles and plates, if what they "
        "correspond to does on the source",
        default=True,
    )
    weight_rigid_group: bpy.props.StringProperty(
        name="Rigid Group",
        description="Vertex group of the target for single pieces: a loose piece with vertices of weight 1 in it "
        "moves by one bone, one with vertices of weight 0 never moves as one, whatever the source does",
        default="Rigid",
    )
    weight_mark: bpy.props.BoolProperty(
        name="Mark Rejected",
        description="Write a color attribute that shows in red which vertices were torn away from their neighbors, "
        "so that their own weights were rejected",
        default=False,
    )


def weight_settings(options: WeightOptions, prefix: str = "") -> WeightSettings:
    """Make the settings of the options; `prefix` is that of the match, if it is known."""
    return settings_of(WeightSettings, options, "weight_", prefix=prefix or WeightSettings.prefix)
