# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""The options of the one button: which kinds are carried over, and those of each kind."""

from typing import Any, Final

import bpy

from ...common.errors import ObjectError
from ...jobs.transfer import Transfer
from ..attributes import AttributeTransfer
from ..rest_like_source import RestLikeSource
from ..rig import RigTransfer
from ..shape_keys import ShapeKeyTransfer
from ..uvs import UVTransfer
from ..weights import WeightTransfer
from .attributes import AttributeOptions, attribute_settings
from .rig import RigOptions, rig_settings
from .shape_keys import ShapeKeyOptions, shape_key_settings
from .uvs import UVOptions, uv_settings
from .weights import WeightOptions, weight_settings

KINDS: Final = {
    "use_rig": RigOptions,
    "use_weights": WeightOptions,
    "use_shape_keys": ShapeKeyOptions,
    "use_uvs": UVOptions,
    "use_attributes": AttributeOptions,
}
"""For each switch the options of its kind."""


class RetargetOptions(RigOptions, WeightOptions, ShapeKeyOptions, UVOptions, AttributeOptions):
    """Which kinds are carried over, and how."""

    use_rig: bpy.props.BoolProperty(
        name="Rig",
        description="Give the target a copy of the source's armature, fitted into its body, and bind it. Left out "
        "if the source has none",
        default=True,
    )
    use_weights: bpy.props.BoolProperty(
        name="Weights",
        description="Carry the source's vertex groups. Left out if it has none",
        default=True,
    )
    use_shape_keys: bpy.props.BoolProperty(
        name="Shape Keys",
        description="Carry the source's shape keys. Left out if it has none",
        default=True,
    )
    use_uvs: bpy.props.BoolProperty(
        name="UV Maps", description="Carry the source's UV maps. Left out if it has none", default=True
    )
    use_attributes: bpy.props.BoolProperty(
        name="Attributes",
        description="Carry color attributes, custom attributes, materials and marked edges",
    )


def option_names(kind: type[Any]) -> tuple[str, ...]:
    """Return the names of the options of one kind."""
    return tuple(kind.__annotations__)


def chosen_transfers(options: RetargetOptions, prefix: str) -> list[Transfer]:
    """Make a transfer for each kind that is switched on, in the order in which they are written.

    The weights come before the rig, so that the rig finds them when it is bound; another rest pose comes after all.

    Raises
    ------
    ObjectError
        If no kind is.
    """
    rig = RigTransfer(rig_settings(options))
    made: list[tuple[bool, Transfer]] = [
        (options.use_weights, WeightTransfer(weight_settings(options, prefix))),
        (options.use_rig, rig),
        (options.use_shape_keys, ShapeKeyTransfer(shape_key_settings(options))),
        (options.use_uvs, UVTransfer(uv_settings(options))),
        (options.use_attributes, AttributeTransfer(attribute_settings(options))),
        (options.use_rig, RestLikeSource(rig_settings(options), rig)),
    ]
    found = [transfer for chosen, transfer in made if chosen]
    if not found:
        raise ObjectError(
            "All kinds are switched off, so there is nothing to carry over. Switch on at least one: Rig, Weights, "
            "Shape Keys, UV Maps or Attributes."
        )
    return found
