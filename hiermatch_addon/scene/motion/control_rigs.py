# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls of a rig whose deforming bones follow others by constraints: which turns which bone.

Names say nothing: a control is turned, and what turns with it is looked at.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from mathutils import Quaternion

from ..armatures import armature_of, pose_of
from .control_pose_io import Controls, Switch, at_rest, leaders_of
from .holders import holds

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from numpy.typing import NDArray

_TURN = 0.4
"""By how much controls are turned to see what follows, in radians, about an axis askew to theirs."""

_AXIS = (0.48, 0.6, 0.64)

_FOLLOWS = np.radians(4.0)
"""How far a bone may be turned otherwise than its control."""

_STAYS = 0.3
"""How far the head of such a bone may move, in units of its length: it turns around its own joint."""

_NEAR = 3.0
"""The same for bones that get a place as well, such as hips that are carried by a control in the middle of the body."""

_PROPERTY = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\["(?P<name>(?:[^"\\]|\\.)*)"\]$')

_OF_CONSTRAINT = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\.constraints\[.*\]\.(influence|mute|enabled)$')

_OF_BONE = re.compile(r'(pose\.)?bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]')

_ROTATION = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\.rotation')


@dataclass(frozen=True, eq=False)
class Candidates:
    """What may move bones: names of free bones, switches at other values than now, and which matter for which bone.

    `followers` are, of what was tried, by what angle and how far off each bone was then; `reach` are, of each free
    bone, all bones and free bones that may depend on it.
    """

    bones: tuple[str, ...]
    free: tuple[str, ...]
    switches: tuple[Switch, ...]
    near: dict[str, set[tuple[str, str]]]
    followers: dict[tuple[tuple[Switch, ...], str], dict[str, tuple[float, float]]] = field(default_factory=dict)
    reach: dict[str, set[str]] = field(default_factory=dict)

    def together(self, names: Sequence[str]) -> list[list[str]]:
        """Share out controls to groups that can be tried at once: no two of one reach the same bone."""
        groups, reached = list[list[str]](), list[set[str]]()
        for name in names:
            own = self.reach[name]
            number = next((i for i, others in enumerate(reached) if not others & own), len(groups))
            if number == len(groups):
                groups.append([])
                reached.append(set())
            groups[number].append(name)
            reached[number] |= own
        return groups


def candidates_of(armature: bpy.types.Object, bones: Sequence[str]) -> Candidates | None:
    """Find what may move some bones of an armature; None if constraints hold none of them: they move by themselves."""
    pose = pose_of(armature).bones
    if not any(_is_held(pose[name]) for name in bones):
        return None
    driven = driven_bones(armature)
    above = {name: leaders_of(armature, name) for name in bones}
    free = [
        name
        for name in dict.fromkeys(each for name in bones for each in above[name])
        if _is_free(pose[name]) and name not in driven
    ]
    found = _switches(armature)
    relevant = {name: {key for key, held in found.items() if held & set(above[name])} for name in bones}
    used = [key for key in found if any(key in keys for keys in relevant.values())]
    switches = [
        switch for key in used for switch in _values(armature, key) if switch.value != float(pose[key[0]][key[1]])
    ]
    inputs, reach = _driver_inputs(armature), {name: set[str]() for name in free}
    for name in dict.fromkeys((*bones, *free)):
        for each in leaders_of(armature, name, inputs):
            if each in reach:
                reach[each].add(name)
    return Candidates(tuple(bones), tuple(free), tuple(switches), relevant, reach=reach)


def worth_trying(
    armature: bpy.types.Object, found: Candidates, bones: Sequence[str], switch: Switch | None = None
) -> list[str]:
    """Return the controls that may turn some bones around their own joints, with a switch those that it matters for."""
    rest = armature_of(armature).bones
    if switch is not None:
        bones = [name for name in bones if (switch.bone, switch.name) in found.near[name]]
    heads = np.array([rest[name].head_local for name in bones]).reshape(-1, 3)
    reach = np.array([rest[name].length for name in bones]) * _STAYS / (2 * np.sin(_TURN / 2))
    places = {name: np.array(rest[name].head_local) for name in found.free}
    return [name for name, place in places.items() if (np.linalg.norm(heads - place, axis=1) <= reach).any()]


def carriers(armature: bpy.types.Object, found: Candidates) -> list[str]:
    """Return the controls that may carry the whole body to another place."""
    pose = pose_of(armature).bones
    return [name for name in found.free if not any(cast("Any", pose[name]).lock_location)]


def tried_controls(
    armature: bpy.types.Object, found: Candidates, groups: Sequence[Sequence[str]], switches: tuple[Switch, ...]
) -> None:
    """Turn the controls of each group in a copy of the armature, group after group, and see what follows."""
    turn = Quaternion(_AXIS, _TURN)
    with at_rest(armature, switches) as alone:
        pose = pose_of(alone.armature).bones
        before = alone.places(found.bones)
        lengths = np.array([armature_of(armature).bones[name].length for name in found.bones])
        starts = {name: alone.matrix(name).to_3x3().normalized() for group in groups for name in group}
        for group in groups:
            for name in group:
                _turn_basis(pose[name], turn)
            alone.update()
            after = alone.places(found.bones)
            turned = _angles(after[:, :3, :3] @ np.linalg.inv(before[:, :3, :3]))
            ways = np.linalg.norm(after[:, :3, 3] - before[:, :3, 3], axis=1) / lengths
            for name in group:
                moved = np.array(alone.matrix(name).to_3x3().normalized() @ starts[name].inverted())
                # Where bones point counts: how they turn about themselves is often shared out along a limb.
                errors = np.arccos((after[:, :3, 1] * (before[:, :3, 1] @ moved.T)).sum(axis=1).clip(-1, 1))
                # What hardly turns does not follow, nor what another of the group moves.
                errors[(turned < _TURN / 2) | [bone not in found.reach[name] for bone in found.bones]] = np.pi
                found.followers[switches, name] = {
                    bone: (float(error), float(way)) for bone, error, way in zip(found.bones, errors, ways, strict=True)
                }
            for name in group:
                _turn_basis(pose[name], Quaternion())


def chosen_controls(
    armature: bpy.types.Object, found: Candidates, switches: tuple[Switch, ...] | None = None
) -> Controls:
    """Choose the control that turns each bone, from what was tried.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    found : Candidates
        After `tried_controls`.
    switches : tuple of Switch, optional
        With which it was tried; of all that was tried if not given, without any if that is enough.
    """
    turning, needed, lost = dict[str, str](), list[Switch](), list[str]()
    for bone in found.bones:
        best = _best_control(armature, found, bone, switches)
        if best is None:
            lost.append(bone)
        else:
            turning[bone] = best[1]
            needed += best[0]
    parents = {bone: getattr(armature_of(armature).bones[bone].parent, "name", "") for bone in lost}
    # What hangs on a bone may turn with its control, as the lower half of an arm in two pieces.
    for bone in list(lost):
        beside = [each for (_, name), each in found.followers.items() if name == turning.get(parents[bone])]
        if any(each[bone][0] <= _FOLLOWS for each in beside):
            lost.remove(bone)
    return Controls(turning, (), switches or tuple(dict.fromkeys(needed)), tuple(lost))


def _best_control(
    armature: bpy.types.Object,
    found: Candidates,
    bone: str,
    switches: tuple[Switch, ...] | None,
    taken: Container[str] = (),
) -> tuple[tuple[Switch, ...], str] | None:
    """Choose the control that turns a bone, of those not `taken`, with the switches that it needs; see above.

    One that turns the bone above it just so is that bone's or one further up, if that bone has any.
    """
    pose = pose_of(armature).bones
    parent = getattr(armature_of(armature).bones[bone].parent, "name", "")
    steered = any(_turns(followers[parent]) for followers in found.followers.values() if parent in followers)
    ranks = {}
    for (tried, name), followers in found.followers.items():
        if switches is None:
            matters = not tried or (tried[0].bone, tried[0].name) in found.near[bone]
        else:
            matters = tried == switches
        if steered and name != bone and followers[parent][0] <= _FOLLOWS:
            continue
        if matters and name not in taken and _turns(followers[bone]):
            carried = sum(each[0] <= _FOLLOWS for each in followers.values())
            shown = pose[name].custom_shape is not None
            way = followers[bone][1]
            ranks[tried, name] = (-len(tried), name == bone, shown, -round(way, 1), carried, -way)
    return max(ranks, key=lambda key: ranks[key]) if ranks else None


def with_carrier(armature: bpy.types.Object, found: Candidates, controls: Controls, placed: Sequence[str]) -> Controls:
    """Let the bones that get a place be moved by the control nearest to them that carries most of the body.

    Others that this control would turn as well, such as the spine above the hips, get one of their own if there is one.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    found : Candidates
        After `tried_controls` of `carriers` with all switches that are needed.
    controls : Controls
        What turns the bones.
    placed : sequence of str
        The bones that get a place.
    """
    turning, places = dict(controls.turning), list[str]()
    for bone in placed:
        ways = {
            name: followers[bone][1]
            for (switches, name), followers in found.followers.items()
            if switches == controls.switches
            and name not in {turning[other] for other in places}
            and followers[bone][0] <= _FOLLOWS
            and 2 * sum(each[0] <= _FOLLOWS for each in followers.values()) > len(found.bones)
        }
        if ways and (bone in ways or min(ways.values()) <= _NEAR):
            turning[bone] = bone if bone in ways else min(ways, key=lambda name: ways[name])
            places.append(bone)
    taken = {turning[bone] for bone in places}
    for bone in [name for name, control in turning.items() if control in taken and name not in places]:
        other = _best_control(armature, found, bone, controls.switches, taken)
        turning[bone] = turning[bone] if other is None else other[1]
    turning = {bone: turning[bone] for bone in places} | turning  # whose control that is comes first
    lost = tuple(bone for bone in controls.lost if bone not in turning)
    return Controls(turning, tuple(places), controls.switches, lost)


def _is_held(bone: bpy.types.PoseBone) -> bool:
    """Tell whether constraints hold a bone."""
    return any(holds(constraint) for constraint in bone.constraints)


def _is_free(bone: bpy.types.PoseBone) -> bool:
    """Tell whether a bone can be turned by hand, and nothing holds it."""
    return not any(cast("Any", bone.lock_rotation)) and not _is_held(bone)


def driven_bones(armature: bpy.types.Object) -> set[str]:
    """Return the names of bones whose rotations drivers move."""
    found = (_ROTATION.match(curve.data_path) for curve in _drivers(armature))
    return {bpy.utils.unescape_identifier(match["bone"]) for match in found if match is not None}


def _driver_inputs(armature: bpy.types.Object) -> dict[str, set[str]]:
    """Names of the bones that drivers of each bone, or of its constraints, look at."""
    found: dict[str, set[str]] = {}
    for curve in _drivers(armature):
        driven = _OF_BONE.match(curve.data_path)
        for target in (target for variable in curve.driver.variables for target in variable.targets):
            looked_at = _OF_BONE.match(target.data_path)
            names = {target.bone_target} if looked_at is None else {bpy.utils.unescape_identifier(looked_at["bone"])}
            if driven is not None and target.id == armature:
                found.setdefault(bpy.utils.unescape_identifier(driven["bone"]), set()).update(names - {""})
    return found


def _switches(armature: bpy.types.Object) -> dict[tuple[str, str], set[str]]:
    """Find the properties of bones by which drivers switch constraints, and the bones that these hold."""
    found: dict[tuple[str, str], set[str]] = {}
    for curve in _drivers(armature):
        held = _OF_CONSTRAINT.match(curve.data_path)
        if held is None:
            continue
        for variable in curve.driver.variables:
            for target in variable.targets:
                match = _PROPERTY.match(target.data_path) if variable.type == "SINGLE_PROP" else None
                if match is not None and target.id == armature:
                    key = bpy.utils.unescape_identifier(match["bone"]), bpy.utils.unescape_identifier(match["name"])
                    found.setdefault(key, set()).add(bpy.utils.unescape_identifier(held["bone"]))
    pose = cast("Any", armature.pose).bones
    return {key: held for key, held in found.items() if key[0] in pose and _is_number(pose[key[0]].get(key[1]))}


def _is_number(value: object) -> bool:
    return isinstance(value, (bool, int, float))


def _values(armature: bpy.types.Object, key: tuple[str, str]) -> tuple[Switch, Switch]:
    """Return the least and the largest value of a switch."""
    bone, name = key
    data = cast("Any", armature.pose).bones[bone]
    if isinstance(data[name], bool):
        return Switch(bone, name, 0.0), Switch(bone, name, 1.0)
    limits = data.id_properties_ui(name).as_dict()
    least, most = (float(limits.get(f"soft_{end}", limits.get(end, other))) for end, other in (("min", 0), ("max", 1)))
    return Switch(bone, name, max(least, 0.0)), Switch(bone, name, min(most, 1.0))


def _drivers(armature: bpy.types.Object) -> list[Any]:
    found = (armature.animation_data, armature_of(armature).animation_data)
    return [curve for animation in found if animation is not None for curve in animation.drivers if not curve.mute]


def _turns(follower: tuple[float, float]) -> bool:
    """Tell whether a bone was turned as a control, around its own joint."""
    return follower[0] <= _FOLLOWS and follower[1] <= _STAYS


def _turn_basis(bone: Any, turn: Quaternion) -> None:  # noqa: ANN401 - a pose bone
    bone.matrix_basis = turn.to_matrix().to_4x4()


def _angles(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of rotations (k, 3, 3)."""
    return np.arccos(((np.trace(rotations, axis1=1, axis2=2) - 1) / 2).clip(-1, 1))
