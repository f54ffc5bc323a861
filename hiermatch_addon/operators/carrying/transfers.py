# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that carry over one kind of thing each, and the one that carries all kinds at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...transfers.attributes import AttributeTransfer
from ...transfers.options.attributes import AttributeOptions, attribute_settings
from ...transfers.options.retarget import RetargetOptions, chosen_transfers
from ...transfers.options.rig import RigOptions, rig_settings
from ...transfers.options.shape_keys import ShapeKeyOptions, shape_key_settings
from ...transfers.options.uvs import UVOptions, uv_settings
from ...transfers.options.weights import WeightOptions, weight_settings
from ...transfers.options.wrap import WrapOptions, wrap_settings
from ...transfers.rest_like_source import RestLikeSource
from ...transfers.rig import RigTransfer
from ...transfers.shape_keys import ShapeKeyTransfer
from ...transfers.uvs import UVTransfer
from ...transfers.weights import WeightTransfer
from ...transfers.wrap import WrapTransfer
from .transfer_operator import TransferOperator

if TYPE_CHECKING:
    from ...jobs.transfer import Transfer


class HIERMATCH_OT_retarget(RetargetOptions, TransferOperator, bpy.types.Operator):
    """Match two meshes and make the one work like the other."""

    bl_idname = "hiermatch.retarget"
    bl_label = "Retarget"
    bl_description = (
        "Match the source with the target if that has not been done, and carry its rig, weights, shape keys and UV "
        "maps over, whatever the pose, build and topology of the target"
    )

    doing = "Retargeting"
    optional = True

    def _transfers(self) -> list[Transfer]:
        return chosen_transfers(self, self.prefix)


class HIERMATCH_OT_fit_rig(RigOptions, TransferOperator, bpy.types.Operator):
    """Give the target a rig."""

    bl_idname = "hiermatch.fit_rig"
    bl_label = "Fit Rig"
    bl_description = (
        "Give the matched meshes a copy of the source's armature each, with its joints where they belong in their pose "
        "and build, and bind them to it"
    )

    optional = True  # the rest pose is; without a rig there is none either

    def _transfers(self) -> list[Transfer]:
        rig = RigTransfer(rig_settings(self))
        return [rig, RestLikeSource(rig_settings(self), rig)]


class HIERMATCH_OT_transfer_weights(WeightOptions, TransferOperator, bpy.types.Operator):
    """Carry weights over."""

    bl_idname = "hiermatch.transfer_weights"
    bl_label = "Transfer Weights"
    bl_description = "Carry the source's vertex groups to the matched meshes, whatever their pose and topology"

    def _transfers(self) -> list[Transfer]:
        return [WeightTransfer(weight_settings(self, self.prefix))]


class HIERMATCH_OT_transfer_shape_keys(ShapeKeyOptions, TransferOperator, bpy.types.Operator):
    """Carry shape keys over."""

    bl_idname = "hiermatch.transfer_shape_keys"
    bl_label = "Transfer Shape Keys"
    bl_description = (
        "Carry the source's shape keys to the matched meshes, whatever their pose and topology, with their values, "
        "ranges and drivers"
    )

    def _transfers(self) -> list[Transfer]:
        return [ShapeKeyTransfer(shape_key_settings(self))]


class HIERMATCH_OT_transfer_uvs(UVOptions, TransferOperator, bpy.types.Operator):
    """Carry UV maps over."""

    bl_idname = "hiermatch.transfer_uvs"
    bl_label = "Transfer UVs"
    bl_description = (
        "Carry the source's UV maps to the matched meshes, whatever their pose and topology, so that its textures fit "
        "them. Islands stay islands: no face is smeared across a seam"
    )

    def _transfers(self) -> list[Transfer]:
        return [UVTransfer(uv_settings(self))]


class HIERMATCH_OT_transfer_attributes(AttributeOptions, TransferOperator, bpy.types.Operator):
    """Carry attributes over."""

    bl_idname = "hiermatch.transfer_attributes"
    bl_label = "Transfer Attributes"
    bl_description = (
        "Carry color and other attributes, materials, sharp edges, creases and custom normals of the source to the "
        "matched meshes, whatever their pose and topology"
    )

    def _transfers(self) -> list[Transfer]:
        return [AttributeTransfer(attribute_settings(self))]


class HIERMATCH_OT_wrap(WrapOptions, TransferOperator, bpy.types.Operator):
    """Lay one mesh onto another."""

    bl_idname = "hiermatch.wrap"
    bl_label = "Wrap"
    bl_description = (
        "Lay the source onto the matched mesh, as a shape key whose slider morphs one into the other. Parts that the "
        "other mesh lacks follow their surroundings"
    )

    def _transfers(self) -> list[Transfer]:
        return [WrapTransfer(wrap_settings(self))]
