# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that makers of rigs give to the bones of a person, by what the bones are."""

from __future__ import annotations

from itertools import product
from typing import Final

_FINGERS: Final = ("thumb", "index", "middle", "ring", "little")

_TRUNK: Final = ("hips", "spine", "chest", "upper_chest", "neck", "head")

_LIMBS: Final = (
    "shoulder",
    "upper_arm",
    "lower_arm",
    "hand",
    "upper_leg",
    "lower_leg",
    "foot",
    "toes",
)


def _table(
    names: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]], patterns: tuple[str, str, str], sides: str
) -> dict[str, str]:
    """Make a table of the names for trunk, limbs and fingers, and how sides and numbers are put to them."""
    (trunk, limbs, fingers), (plain, limb, finger) = names, patterns
    made = {what: plain.format(name) for what, name in zip(_TRUNK, trunk, strict=True)}
    for side, word in zip(("left", "right"), sides.split(), strict=True):
        made |= {f"{side}_{what}": limb.format(name, side=word) for what, name in zip(_LIMBS, limbs, strict=True)}
        for (what, name), number in product(zip(_FINGERS, fingers, strict=True), (1, 2, 3)):
            made[f"{side}_{what}_{number}"] = finger.format(name, number, side=word)
    return made


_VRM_JOINTS: Final = ("Proximal", "Intermediate", "Distal")

_VRM_THUMB: Final = ("Metacarpal", "Proximal", "Distal")


def _vrm() -> dict[str, str]:
    """Names of the humanoid bones of VRM 1.0, whose thumbs begin with a bone of the palm."""
    trunk = ("hips", "spine", "chest", "upperChest", "neck", "head")
    limbs = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
    fingers = ("Thumb", "Index", "Middle", "Ring", "Little")
    made = _table((trunk, limbs, fingers), ("{0}", "{side}{0}", "{side}{0}{1}"), "left right")
    for what, name in made.items():
        if what[-1:].isdigit():
            made[what] = name[:-1] + (_VRM_THUMB if "thumb" in what else _VRM_JOINTS)[int(what[-1]) - 1]
    return made


NAME_TABLES: Final = {
    "VRM": _vrm(),
    "MIXAMO": _table(
        (
            ("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
            ("Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase"),
            ("Thumb", "Index", "Middle", "Ring", "Pinky"),
        ),
        ("mixamorig:{0}", "mixamorig:{side}{0}", "mixamorig:{side}Hand{0}{1}"),
        "Left Right",
    ),
    "UNREAL": _table(
        (
            ("pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head"),
            ("clavicle", "upperarm", "lowerarm", "hand", "thigh", "calf", "foot", "ball"),
            ("thumb", "index", "middle", "ring", "pinky"),
        ),
        ("{0}", "{0}_{side}", "{0}_0{1}_{side}"),
        "l r",
    ),
    "RIGIFY": _table(
        (
            ("spine", "spine.001", "spine.002", "spine.003", "spine.004", "spine.006"),
            ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe"),
            ("thumb", "f_index", "f_middle", "f_ring", "f_pinky"),
        ),
        ("DEF-{0}", "DEF-{0}.{side}", "DEF-{0}.0{1}.{side}"),
        "L R",
    ),
}
"""For each standard the name of each bone; see `humanoid_bones` for what they are."""
