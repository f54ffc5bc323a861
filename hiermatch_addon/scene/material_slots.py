# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of faces, and the slots of an object that they stand in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.access import mesh_of
from .attribute_io import read_face_materials, write_face_materials

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray


def read_materials(obj: bpy.types.Object) -> tuple[list[bpy.types.Material | None], NDArray[np.int64]]:
    """Read the materials in the slots of an object, and for each face the number of its slot, (f,).

    A face that names a slot which is not there shows the last one.
    """
    materials = [slot.material for slot in obj.material_slots]
    return materials, read_face_materials(mesh_of(obj)).clip(0, max(len(materials) - 1, 0))


def assign_materials(
    obj: bpy.types.Object, materials: list[bpy.types.Material | None], numbers: NDArray[np.int64]
) -> int:
    """Give each face of an object one of some materials, (f,); return how many of them are used.

    A material that is in a slot already is taken there; the others are added in new slots, in their order.
    """
    present = [slot.material for slot in obj.material_slots]
    slots = np.zeros(len(materials), np.int64)
    used = np.unique(numbers).tolist()
    added: Any = mesh_of(obj).materials
    for number in used:
        material = materials[number]
        if material not in present:
            added.append(material)
            present.append(material)
        slots[number] = present.index(material)
    write_face_materials(mesh_of(obj), slots[numbers])
    return len(used)
