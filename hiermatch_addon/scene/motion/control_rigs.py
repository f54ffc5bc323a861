# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls of a rig whose deforming bones follow others by constraints: which turns which bone, and posing them.

Names say nothing: a control is turned, and what turns with it is looked at.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from mathutils import Matrix, Quaternion

from ..armatures import armature_of

if TYPE_CHECKING:
    from collections.abc import Container, Iterator, Sequence

    from numpy.typing import NDArray

__all__ = [
    "Candidates",
    "Controls",
    "Switch",
    "candidates_of",
    "carriers",
    "chosen_controls",
    "posed_controls",
    "set_switches",
    "tried_controls",
    "with_carrier",
    "worth_trying",
]

_TURN = 0.4
"""By how much controls are turned to see what follows, in radians, about an axis askew to theirs."""

_AXIS = (0.48, 0.6, 0.64)

_FOLLOWS = np.radians(4.0)
"""How far a bone may be turned otherwise than its control."""

_STAYS = 0.3
"""How far the head of such a bone may move, in units of its length: it turns around its own joint."""

_NEAR = 3.0
"""The same for bones that get a place as well, such as hips that are carried by a control in the middle of the body."""

_LEVELS = 24
"""Most controls of which each hangs on the one before."""

_PROPERTY = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\["(?P<name>(?:[^"\\]|\\.)*)"\]$')

_OF_CONSTRAINT = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\.constraints\[.*\]\.(influence|mute|enabled)$')

_CHANNELS = ("location", "rotation_quaternion", "rotation_euler", "rotation_axis_angle", "scale")

_ROTATION = re.compile(r'pose\.bones\["(?P<bone>(?:[^"\\]|\\.)*)"\]\.rotation')


@dataclass(frozen=True)
class Switch:
    """A property of a bone that says whether constraints hold, and a value for it."""

    bone: str
    name: str
    value: float


@dataclass(frozen=True)
class Controls:
    """What moves deforming bones of a control rig.

    Attributes
    ----------
    turning : dict
        For each bone that is to be moved the control that turns it: itself, if nothing holds it.
    placed : tuple of str
        Those of the bones whose control also gets a place, as it carries most of the body.
    switches : tuple of Switch
        What has to be set for that.
    lost : tuple of str
        Bones without a control.
    """

    turning: dict[str, str]
    placed: tuple[str, ...] = ()
    switches: tuple[Switch, ...] = ()
    lost: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Candidates:
    """What may move bones: names of free bones, switches at other values than now, and which matter for which bone."""

    bones: tuple[str, ...]
    free: tuple[str, ...]
    switches: tuple[Switch, ...]
    near: dict[str, set[tuple[str, str]]]
    followers: dict[tuple[tuple[Switch, ...], str], dict[str, tuple[float, float]]] = field(default_factory=dict)


def candidates_of(armature: bpy.types.Object, bones: Sequence[str]) -> Candidates | None:
    """Find what may move some bones of an armature; None if constraints hold none of them: they move by themselves."""
    pose = cast("bpy.types.Pose", armature.pose).bones
    if not any(_is_held(pose[name]) for name in bones):
        return None
    driven = _driven(armature)
    above = {name: _above(armature, name) for name in bones}
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
    return Candidates(tuple(bones), tuple(free), tuple(switches), relevant)


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
    pose = cast("bpy.types.Pose", armature.pose).bones
    return [name for name in found.free if not any(cast("Any", pose[name]).lock_location)]


def tried_controls(
    armature: bpy.types.Object, found: Candidates, names: Sequence[str], switches: tuple[Switch, ...]
) -> None:
    """Turn some controls, one after the other, see what follows, and leave everything as it was."""
    pose = cast("bpy.types.Pose", armature.pose).bones
    turn = Quaternion(_AXIS, _TURN)
    with _at_rest(armature, switches):
        before = _places(armature, found.bones)
        lengths = np.array([armature_of(armature).bones[name].length for name in found.bones])
        starts = {name: pose[name].matrix.to_3x3().normalized() for name in names}
        for name in names:
            _turn_basis(pose[name], turn)
            _update()
            moved = np.array(pose[name].matrix.to_3x3().normalized() @ starts[name].inverted())
            _turn_basis(pose[name], Quaternion())
            after = _places(armature, found.bones)
            # Where bones point counts: how they turn about themselves is often shared out along a limb.
            axes, wished = after[:, :3, 1], before[:, :3, 1] @ moved.T
            errors = np.arccos((axes * wished).sum(axis=1).clip(-1, 1))
            turned = after[:, :3, :3] @ np.linalg.inv(before[:, :3, :3])
            errors[_angles(turned) < _TURN / 2] = np.pi  # what hardly turns does not follow
            ways = np.linalg.norm(after[:, :3, 3] - before[:, :3, 3], axis=1) / lengths
            found.followers[switches, name] = {
                bone: (float(error), float(way)) for bone, error, way in zip(found.bones, errors, ways, strict=True)
            }
        _update()


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
    pose = cast("bpy.types.Pose", armature.pose).bones
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


def set_switches(armature: bpy.types.Object, switches: Sequence[Switch]) -> list[str]:
    """Set properties, and return those that had another value, as a person reads them."""
    pose = cast("Any", armature.pose).bones
    changed = []
    for switch in switches:
        bone = pose[switch.bone]
        if float(bone[switch.name]) != switch.value:
            changed.append(f"{switch.name} ({switch.bone})")
            bone[switch.name] = type(bone[switch.name])(switch.value)
    if changed:
        armature.update_tag(refresh={"OBJECT", "DATA", "TIME"})
    return changed


def posed_controls(
    armature: bpy.types.Object,
    controls: Controls,
    turns: NDArray[np.float64],
    heads: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pose the controls so that the bones turn as wanted, pose after pose, and leave everything as it was.

    Parameters
    ----------
    armature : bpy.types.Object
        The armature object.
    controls : Controls
        What turns what.
    turns : (f, k, 3, 3) array of float
        How each bone of `controls.turning`, in that order, is turned against its rest, in the armature's space.
    heads : (f, k, 3) array of float
        Where it is; this counts only for those that get a place.

    Returns
    -------
    bases : (f, k, 4, 4) array of float
        The transform of each control against its parent.
    missed : (f, k) array of float
        By what angle each bone points elsewhere in the end, in radians.
    """
    pose = cast("bpy.types.Pose", armature.pose).bones
    names = list(controls.turning)
    levels = _levels(armature, list(dict.fromkeys(controls.turning.values())))
    bases = np.tile(np.eye(4), (*turns.shape[:2], 1, 1))
    missed = np.zeros(turns.shape[:2])
    with _at_rest(armature, controls.switches):
        rest = _places(armature, names)
        starts = {name: pose[control].matrix.copy() for name, control in controls.turning.items()}
        for frame in range(len(turns)):
            done: set[str] = set()
            for level in levels:
                for number, name in enumerate(names):
                    control = controls.turning[name]
                    if control not in level or control in done:
                        continue
                    done.add(control)
                    pose_of = turns[frame, number], heads[frame, number], rest[number, :3, 3]
                    _pose(pose[control], starts[name], pose_of, place=name in controls.placed)
                _update()
            now = _places(armature, names)
            turned = now[:, :3, :3] @ np.linalg.inv(rest[:, :3, :3])
            axes = [np.einsum("kij,kj->ki", each, rest[:, :3, 1]) for each in (turned, turns[frame])]
            missed[frame] = np.arccos((axes[0] * axes[1]).sum(axis=1).clip(-1, 1))
            for number, name in enumerate(names):
                bases[frame, number] = np.array(pose[controls.turning[name]].matrix_basis)
    return bases, missed


def _pose(bone: Any, start: Matrix, wished: tuple[NDArray[np.float64], ...], *, place: bool) -> None:  # noqa: ANN401
    """Pose one control: turned as its bone, and, if that gets a place, moved with it as one.

    `wished` are the turn (3, 3) and the head (3,) of the bone, and its head at rest.
    """
    turn, head, rest = wished
    wanted = Matrix((turn @ np.array(start.to_3x3())).tolist()).to_4x4()
    if place:
        wanted.translation = (head + turn @ (np.array(start.translation) - rest)).tolist()
    else:
        wanted.translation = bone.matrix.translation
    bone.matrix = wanted
    if not place:
        bone.location = (0, 0, 0)
    bone.scale = (1, 1, 1)


def _levels(armature: bpy.types.Object, controls: list[str]) -> list[set[str]]:
    """Sort controls so that each comes after all that it follows."""
    above = {name: set(_above(armature, name)[1:]) & set(controls) - {name} for name in controls}
    levels, done = list[set[str]](), set[str]()
    while len(done) < len(controls) and len(levels) < _LEVELS:
        ready = {name for name in controls if name not in done and above[name] <= done}
        ready = ready or {name for name in controls if name not in done}
        levels.append(ready)
        done |= ready
    return levels


def _above(armature: bpy.types.Object, name: str) -> list[str]:
    """Return a bone and all bones that it hangs on or follows, in the order in which they are met."""
    pose, found = cast("bpy.types.Pose", armature.pose).bones, [name]
    for each in found:
        bone = pose[each]
        targets = [] if bone.parent is None else [bone.parent.name]
        for constraint in cast("Any", bone.constraints):
            holders = (constraint, *getattr(constraint, "targets", ()))
            targets += [each.subtarget for each in holders if getattr(each, "target", None) == armature]
            if getattr(constraint, "pole_target", None) == armature:
                targets.append(constraint.pole_subtarget)
        found += [target for target in dict.fromkeys(targets) if target in pose and target not in found]
    return found


def _is_held(bone: bpy.types.PoseBone) -> bool:
    """Tell whether constraints hold a bone."""
    return any(not constraint.mute for constraint in bone.constraints)


def _is_free(bone: bpy.types.PoseBone) -> bool:
    """Tell whether a bone can be turned by hand, and nothing holds it."""
    return not any(cast("Any", bone.lock_rotation)) and not _is_held(bone)


def _driven(armature: bpy.types.Object) -> set[str]:
    """Names of bones whose rotations drivers move."""
    found = (_ROTATION.match(curve.data_path) for curve in _drivers(armature))
    return {bpy.utils.unescape_identifier(match["bone"]) for match in found if match is not None}


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
    return [curve for animation in found if animation is not None for curve in animation.drivers]


@contextmanager
def _at_rest(armature: bpy.types.Object, switches: Sequence[Switch]) -> Iterator[None]:
    """Lend an armature at rest, without action, with switches set, and put everything back."""
    animation: Any = armature.animation_data or armature.animation_data_create()
    before = animation.action, getattr(animation, "action_slot", None), animation.use_nla
    pose = cast("Any", armature.pose).bones
    stood = [[list(getattr(bone, channel)) for channel in _CHANNELS] for bone in pose]
    values = [(switch, pose[switch.bone][switch.name]) for switch in switches]
    try:
        animation.use_nla, animation.action = False, None
        for bone in pose:
            bone.matrix_basis.identity()
        set_switches(armature, switches)
        armature.update_tag(refresh={"OBJECT", "DATA", "TIME"})
        _update()
        yield
    finally:
        for switch, value in values:
            pose[switch.bone][switch.name] = value
        animation.use_nla = before[2]
        if before[0] is not None:
            animation.action = before[0]
            if before[1] is not None:
                animation.action_slot = before[1]
        for bone, channels in zip(pose, stood, strict=True):
            for channel, value in zip(_CHANNELS, channels, strict=True):
                setattr(bone, channel, value)
        armature.update_tag(refresh={"OBJECT", "DATA", "TIME"})
        _update()


def _turns(follower: tuple[float, float]) -> bool:
    """Tell whether a bone was turned as a control, around its own joint."""
    return follower[0] <= _FOLLOWS and follower[1] <= _STAYS


def _turn_basis(bone: Any, turn: Quaternion) -> None:  # noqa: ANN401 - a pose bone
    bone.matrix_basis = turn.to_matrix().to_4x4()


def _places(armature: bpy.types.Object, names: Sequence[str]) -> NDArray[np.float64]:
    """Where bones are, in the armature's space, without scale, (k, 4, 4)."""
    pose = cast("bpy.types.Pose", armature.pose).bones
    found = np.array([pose[name].matrix for name in names], np.float64).reshape(-1, 4, 4)
    found[:, :3, :3] /= np.maximum(np.linalg.norm(found[:, :3, :3], axis=1, keepdims=True), np.finfo(float).tiny)
    return found


def _angles(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of rotations (k, 3, 3)."""
    return np.arccos(((np.trace(rotations, axis1=1, axis2=2) - 1) / 2).clip(-1, 1))


def _update() -> None:
    cast("Any", bpy.context).view_layer.update()
