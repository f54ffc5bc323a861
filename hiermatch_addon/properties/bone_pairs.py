# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""The table of pairs of bones on a scene: read and written as pairs of numbers, and as text."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

from ...engine import BonePairing
from ..common.errors import ObjectError
from ..common.file_reading import BAD_FILE, parsed_json, read_text
from ..common.file_writing import write_whole
from ..common.phrases import listed
from ..scene.armatures import armature_of
from ..scene.motion.rest_changes import REST_NUMBERS, change_of_rest, rest_points
from ..scene.motion.rigs import object_rotation, own_skeleton

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray


_FORMAT, _VERSION = "HierMatch bone pairs", 1

_VALUES = {"turn": 4, "place": 3, "upright": 4}
"""How many numbers say what was seen on the surface of a row."""

_RESTS = {"source_rest": REST_NUMBERS, "target_rest": REST_NUMBERS}
"""How many numbers say how the bones of a row lay then.  Files of older versions have none."""


def _is_armature(_owner: bpy.types.PropertyGroup, obj: bpy.types.Object) -> bool:
    return obj.type == "ARMATURE"


def _unsee(row: Any, _context: bpy.types.Context) -> None:  # noqa: ANN401 - a row of the table
    """Forget what was seen on the surface of other bones than the row names now."""
    row.is_seen = False


class HIERMATCH_PG_bone_pair(bpy.types.PropertyGroup):
    """A pair of bones: a row of the table of two armatures."""

    source: bpy.props.StringProperty(
        name="Source Bone", description="Bone of the source; empty for none", update=_unsee
    )
    target: bpy.props.StringProperty(
        name="Target Bone", description="Bone of the target that stands for it", update=_unsee
    )
    score: bpy.props.FloatProperty(
        name="Score", description="How well the two agree, from 0 to 1", min=0, max=1, default=1
    )
    locked: bpy.props.BoolProperty(
        name="Lock", description="Keep this row when bones are paired again; without a source, the bone stays alone"
    )
    source_rig: bpy.props.PointerProperty(
        name="Source Rig", description="Armature of the source", type=bpy.types.Object, poll=_is_armature
    )
    target_rig: bpy.props.PointerProperty(
        name="Target Rig", description="Armature of the target", type=bpy.types.Object, poll=_is_armature
    )
    turn: bpy.props.FloatVectorProperty(
        name="Turn",
        description="How the target's surface is turned against the source's at rest, in the spaces of the armatures",
        size=4,
        subtype="QUATERNION",
        default=(1, 0, 0, 0),
    )
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Where the head of the source bone lies in the target, in the target armature's space"
    )
    upright: bpy.props.FloatVectorProperty(
        name="Standing",
        description="How the target stands, turned against the source, in the spaces of the armatures",
        size=4,
        subtype="QUATERNION",
        default=(1, 0, 0, 0),
    )
    source_rest: bpy.props.FloatVectorProperty(
        name="Source Bone at Rest",
        description="Head, tail and a point beside the head of the source bone when turn and place were seen",
        size=REST_NUMBERS,
    )
    target_rest: bpy.props.FloatVectorProperty(
        name="Target Bone at Rest",
        description="Head, tail and a point beside the head of the target bone when turn and place were seen",
        size=REST_NUMBERS,
    )
    is_seen: bpy.props.BoolProperty(
        name="Seen", description="Whether turn and place were seen on the surface; a row made by hand has none"
    )


def bone_pairs_of(scene: bpy.types.Scene) -> Any:  # noqa: ANN401 - a collection of Blender's
    """Return the table of pairs of bones on a scene, of all armatures."""
    return cast("Any", scene).hiermatch_bone_pairs


def rows_of(scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object) -> list[Any]:
    """Return the rows of two armatures."""
    return [row for row in bone_pairs_of(scene) if row.source_rig == source and row.target_rig == target]


def pairing_notes(scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object) -> list[str]:
    """Say which rows of two armatures are out of date: their bones are gone, or lie otherwise at rest than they did."""
    rows, notes = rows_of(scene, source, target), []
    named = [(rig, name) for row in rows for rig, name in ((source, row.source), (target, row.target))]
    if lost := list(dict.fromkeys(name for rig, name in named if name and name not in armature_of(rig).bones)):
        notes.append(
            f"Pairs of bones that are gone, or called otherwise by now, were left out: {listed(lost)}. Pair "
            "the bones again."
        )
    present = _present(rows, source, target)
    held = _Changes(present, source, target).held
    if moved := [row.target for row, holds in zip(present, held, strict=True) if row.is_seen and not holds]:
        notes.append(
            f"The rest pose has changed since bones were paired, and these go by how they lie now: {listed(moved)} of "
            f'"{target.name}". Pair the bones again.'
        )
    return notes


def held_pairs(
    scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object
) -> tuple[list[tuple[int, int]], list[int]]:
    """Return what the locked rows say: pairs of numbers of bones, and bones of the target that stay alone.

    Rows whose bones there are no more count for nothing.
    """
    numbers = _numbers(source), _numbers(target)
    locked = [row for row in rows_of(scene, source, target) if row.locked and row.target in numbers[1]]
    pairs = [(numbers[0][row.source], numbers[1][row.target]) for row in locked if row.source in numbers[0]]
    return pairs, [numbers[1][row.target] for row in locked if not row.source]


def write_pairing(
    scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object, pairing: BonePairing
) -> None:
    """Write pairs, in the armatures' own spaces, into the table, in place of those that are not locked."""
    names = [tuple(bone.name for bone in armature_of(rig).bones) for rig in (source, target)]
    locked = {(row.source, row.target) for row in rows_of(scene, source, target) if row.locked}
    remove_rows(scene, [row for row in rows_of(scene, source, target) if not row.locked or row.source])
    upright = _quaternion(pairing.upright)
    rests = rest_points(source, names[0]), rest_points(target, names[1])
    for number in range(len(pairing)):
        row = bone_pairs_of(scene).add()
        row.source, row.target = names[0][pairing.sources[number]], names[1][pairing.targets[number]]
        row.name = row.target
        row.source_rig, row.target_rig = source, target
        row.score = min(1.0, max(0.0, float(pairing.scores[number])))
        row.locked = (row.source, row.target) in locked
        row.turn = _quaternion(pairing.rotations[number])
        row.place = pairing.places[number].tolist()
        row.source_rest = rests[0][pairing.sources[number]].tolist()
        row.target_rest = rests[1][pairing.targets[number]].tolist()
        row.upright, row.is_seen = upright, True


def pairing_of(scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object) -> BonePairing:
    """Read the pairs of two armatures, in the armatures' own spaces.

    A row that was made by hand, or whose bones lie otherwise at rest than when it was seen, is turned as the bones are:
    its turn takes the direction of the one to the other's.  What moved, turned or scaled all bones of an armature, as
    Apply does, moves, turns and scales what was seen.

    Raises
    ------
    ObjectError
        If there is none.
    """
    numbers = _numbers(source), _numbers(target)
    rows = _present(rows_of(scene, source, target), source, target)
    if not rows:
        raise ObjectError(f'No bones of "{source.name}" and "{target.name}" are paired. Pair their bones first.')
    trees = own_skeleton(source), own_skeleton(target)
    sources = np.array([numbers[0][row.source] for row in rows], np.int64)
    targets = np.array([numbers[1][row.target] for row in rows], np.int64)
    changes = _Changes(rows, source, target)
    seen = [row.is_seen and holds for row, holds in zip(rows, changes.held, strict=True)]
    upright = object_rotation(target).T @ object_rotation(source)
    if any(seen):
        upright = changes.turned(rows[seen.index(True)].upright)
    turns, places = [], []
    for row, is_seen, one, other in zip(rows, seen, sources, targets, strict=True):
        if is_seen:
            turns.append(changes.turned(row.turn))
            places.append(changes.placed(row.place))
            continue
        start, goal = upright @ trees[0].axes[one], trees[1].axes[other]
        swing = Matrix.Identity(3)
        if np.linalg.norm(start) > 0 and np.linalg.norm(goal) > 0:
            swing = Vector(start.tolist()).rotation_difference(Vector(goal.tolist())).to_matrix()
        turns.append(np.array(swing, np.float64) @ upright)
        places.append(trees[1].heads[other])
    order = np.argsort(targets, kind="stable")
    scores = np.array([row.score for row in rows], np.float64)
    return BonePairing(
        sources[order], targets[order], scores[order], np.array(turns)[order], np.array(places)[order], upright
    )


def add_row(scene: bpy.types.Scene, rigs: tuple[bpy.types.Object, bpy.types.Object], bones: tuple[str, str]) -> None:
    """Add a locked row that was made by hand; with an empty name of a source bone, the target's bone stays alone.

    Other rows of the same target bone go.

    Raises
    ------
    ObjectError
        If an armature has no such bone.
    """
    for rig, name in zip(rigs, bones, strict=True):
        if name not in armature_of(rig).bones and (name or rig == rigs[1]):
            raise ObjectError(f'"{rig.name}" has no bone called "{name}".')
    remove_rows(scene, [row for row in rows_of(scene, *rigs) if row.target == bones[1]])
    row = bone_pairs_of(scene).add()
    row.source_rig, row.target_rig = rigs
    row.source, row.target = bones
    row.name, row.locked = bones[1], True


def clear_rows(scene: bpy.types.Scene, rigs: tuple[bpy.types.Object, bpy.types.Object], *, locked: bool) -> int:
    """Take all rows of two armatures out of the table, the locked ones as well if wanted; return how many."""
    gone = [row for row in rows_of(scene, *rigs) if locked or not row.locked]
    remove_rows(scene, gone)
    return len(gone)


def save_pairs(scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object, path: Path) -> None:
    """Write the table of two armatures into a file, as JSON.

    Raises
    ------
    ObjectError
        If it is empty, or the file cannot be written.
    """
    rows = rows_of(scene, source, target)
    if not rows:
        raise ObjectError(f'No bones of "{source.name}" and "{target.name}" are paired. Pair their bones first.')
    pairs = [
        {"source": row.source, "target": row.target, "score": row.score, "locked": row.locked}
        | ({name: list(getattr(row, name)) for name in _VALUES | _RESTS} if row.is_seen else {})
        for row in rows
    ]
    text = {"format": _FORMAT, "version": _VERSION, "source": source.name, "target": target.name, "pairs": pairs}
    write_whole(path, json.dumps(text, indent=1).encode("utf8"))


def load_pairs(
    scene: bpy.types.Scene, source: bpy.types.Object, target: bpy.types.Object, path: Path
) -> tuple[int, list[str]]:
    """Read a table from a file in place of that of two armatures.

    Returns
    -------
    count : int
        How many pairs were read.
    missing : list of str
        Names of bones that the armatures do not have; their pairs were left out.

    Raises
    ------
    ObjectError
        If it is no such file, or no pair fits; nothing is changed then.
    """
    text = read_text(path)
    try:
        read = parsed_json(text)
        if read["format"] != _FORMAT or read["version"] != _VERSION:
            raise ValueError
        pairs = [_checked(pair) for pair in read["pairs"]]
    except BAD_FILE as error:
        raise ObjectError("The file holds no pairs of bones. Choose one that was exported from HierMatch.") from error
    bones = [set(armature_of(rig).bones.keys()) for rig in (source, target)]
    wanted = [[pair[side] for pair in pairs if pair[side]] for side in ("source", "target")]
    missing = [name for names, known in zip(wanted, bones, strict=True) for name in names if name not in known]
    fitting = [
        pair for pair in pairs if pair["target"] in bones[1] and (not pair["source"] or pair["source"] in bones[0])
    ]
    if not fitting:
        raise ObjectError(f'No pair of the file fits the bones of "{source.name}" and "{target.name}".')
    remove_rows(scene, rows_of(scene, source, target))
    for pair in fitting:
        row = bone_pairs_of(scene).add()
        row.source_rig, row.target_rig, row.name = source, target, pair["target"]
        for name, value in pair.items():
            setattr(row, name, value)
        row.is_seen = all(name in pair for name in _VALUES)
    return len(fitting), list(dict.fromkeys(missing))


def _checked(pair: dict[str, Any]) -> dict[str, Any]:
    """Take what is known of a pair.

    Raises
    ------
    ValueError, KeyError, TypeError
        If it is no pair.
    """
    found: dict[str, Any] = {"source": str(pair["source"]), "target": str(pair["target"])}
    found |= {"score": float(pair.get("score", 1.0)), "locked": bool(pair.get("locked", False))}
    if all(name in pair for name in _VALUES):
        sizes = {name: size for name, size in (_VALUES | _RESTS).items() if name in pair}
        found |= {name: [float(value) for value in pair[name]] for name in sizes}
        if any(len(found[name]) != size for name, size in sizes.items()):
            raise ValueError
    return found


class _Changes:
    """What became of the spaces of two armatures since rows, whose bones there are, were seen.

    Parameters
    ----------
    rows : sequence
        The rows.
    source, target : bpy.types.Object
        The armatures.

    Attributes
    ----------
    held : (n,) array of bool
        Whether what was seen of a row holds: its bones changed as all others did.
    """

    def __init__(self, rows: Sequence[Any], source: bpy.types.Object, target: bpy.types.Object) -> None:
        self.held, self._linear, self._turns = np.ones(len(rows), bool), np.eye(3), [np.eye(3), np.eye(3)]
        for number, (side, rig) in enumerate((("source", source), ("target", target))):
            then = np.array([getattr(row, f"{side}_rest") for row in rows], np.float64).reshape(-1, REST_NUMBERS)
            now = rest_points(rig, [getattr(row, side) for row in rows])
            self._linear, self._translation, held = change_of_rest(then, now)  # of the target at last
            self._turns[number] = self._linear / np.cbrt(np.linalg.det(self._linear))
            self.held &= held

    def turned(self, quaternion: Any) -> NDArray[np.float64]:  # noqa: ANN401 - a vector of Blender's
        """Return a turn of the target against the source as it is now, as a matrix."""
        return self._turns[1] @ _matrix(quaternion) @ self._turns[0].T

    def placed(self, place: Any) -> NDArray[np.float64]:  # noqa: ANN401 - a vector of Blender's
        """Return where a place in the target is now."""
        return self._linear @ np.array(place, np.float64) + self._translation


def _numbers(armature: bpy.types.Object) -> dict[str, int]:
    """Return the number of each bone by its name."""
    return {bone.name: number for number, bone in enumerate(armature_of(armature).bones)}


def _present(rows: Sequence[Any], source: bpy.types.Object, target: bpy.types.Object) -> list[Any]:
    """Return those rows of two armatures whose bones there are."""
    bones = armature_of(source).bones, armature_of(target).bones
    return [row for row in rows if row.source in bones[0] and row.target in bones[1]]


def remove_rows(scene: bpy.types.Scene, rows: Sequence[Any]) -> None:
    """Take rows out of the table."""
    table, gone = bone_pairs_of(scene), {row.as_pointer() for row in rows}
    for number in [number for number, row in enumerate(table) if row.as_pointer() in gone][::-1]:
        table.remove(number)


def _quaternion(matrix: NDArray[np.float64]) -> Quaternion:
    return Matrix(matrix.tolist()).to_quaternion()


def _matrix(values: Any) -> NDArray[np.float64]:  # noqa: ANN401 - a vector of Blender's
    return np.array(Quaternion(values).normalized().to_matrix(), np.float64)
