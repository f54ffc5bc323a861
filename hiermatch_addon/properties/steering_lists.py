# SPDX-License-Identifier: GPL-3.0-or-later
"""The lists of landmarks and of matched points, filled with what the two meshes have in common.

Blender draws lists of what is stored in properties only.  What counts is on the meshes; the lists repeat it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..common.errors import ObjectError
from ..scene.character import parts_of, side_of
from ..scene.pair import is_own
from ..storage.halves import find_carriers, find_common, in_order, meant
from ..storage.landmarks import find_landmarks
from ..storage.stored_match import StoredMatch
from .panel_state import picked, summary_of

if TYPE_CHECKING:
    from ..scene.character import Side
    from ..storage.halves import Half

_REVISIONS = 1 << 30
"""After so many changes the count begins anew."""


def steered_pair(scene: bpy.types.Scene) -> tuple[Side, Side] | None:
    """Return the two sides that a scene's panels are about: those picked, else those of the last match."""
    state: Any = scene
    source, target = (_steered(scene, chosen, number) for number, chosen in enumerate(picked(state.hiermatch)))
    if source is None or target is None or source == target:
        return None
    return source, target


def _steered(scene: bpy.types.Scene, chosen: bpy.types.ID | None, number: int) -> Side | None:
    """Return what is picked, else that side of the last match, 0 for what is shown as its source."""
    summary = summary_of(scene)
    if chosen is not None:
        return picked_side(scene, chosen)
    if not summary.key:
        return None
    name, role = (summary.source, summary.target)[number], ("source", "target")[number != summary.swapped]
    called = scene.objects.get(name)
    if called is not None and find_carriers([called], summary.key, summary.prefix, role):
        return called
    half = meant(find_carriers(scene.objects, summary.key, summary.prefix, role), name)
    if half is None:
        return called if called is not None and called.type == "MESH" else None
    return half.obj


def picked_side(scene: bpy.types.Scene, chosen: bpy.types.ID) -> Side | None:
    """Return the meshes that are meant by what is picked, as far as a view layer has them; None if none has any."""
    sides = (_picked_side(chosen, layer) for layer in _view_layers(scene))
    return next((side for side in sides if side is not None), None)


def _picked_side(chosen: bpy.types.ID, view_layer: bpy.types.ViewLayer) -> Side | None:
    """Return the meshes that are picked, as far as a view layer has them; None if it has none."""
    try:
        side = side_of(chosen, view_layer)
    except ObjectError:
        return None
    return side if parts_of(side)[0].type == "MESH" else None


def _view_layers(scene: bpy.types.Scene) -> list[bpy.types.ViewLayer]:
    """Return the view layers of a scene, those first that windows show: this one, or, for a timer, any."""
    context: Any = bpy.context
    windows = filter(None, (context.window, *context.window_manager.windows))
    return [*(window.view_layer for window in windows if window.scene == scene), *scene.view_layers]


def common_match(scene: bpy.types.Scene, pair: tuple[Side, Side] | None = None) -> tuple[Half, Half] | None:
    """Return the two sides, source first, of the match of a pair; None if there is none.

    The pair is the one that a scene's panels are about if none is given.  Of several matches, it is the one that the
    summary tells of, else the first.
    """
    pair = pair or steered_pair(scene)
    found = [] if pair is None else find_common(*pair)
    summary = summary_of(scene)
    # The same points, written with several prefixes, have the same key.
    return max(
        found, key=lambda halves: (halves[0].key == summary.key, halves[0].prefix == summary.prefix), default=None
    )


def check_steered(scene: bpy.types.Scene) -> None:
    """Make sure that matches of the two sides that a scene's panels are about can be shown and refined.

    Raises
    ------
    ObjectError
        If one is another file's: only the other one keeps such matches, see `keep_linked`.
    """
    for side in steered_pair(scene) or ():
        if not is_own(side):
            raise ObjectError(
                f'"{side.name}" is linked from another file, so its matches cannot be shown or refined. Make object '
                "and data local first (Object > Relations > Make Local)."
            )


def point_name(prefix: str, number: int) -> str:
    """Return the name of the vertex group of a matched point, numbered from 1."""
    return f"{prefix}.{number:03d}"


def landmark_label(number: int) -> str:
    """Return what a landmark is called that the user has not named."""
    return f"Landmark {number}"


def sync_lists(scene: bpy.types.Scene) -> None:
    """Fill both lists of a scene, and write to it only if they have changed."""
    owner: Any = scene
    steering = owner.hiermatch_steering
    changed = [_fill(steering.landmarks, _landmark_rows(scene)), _fill(steering.pairs, pair_rows(scene))]
    if any(changed):
        steering.revision = (steering.revision + 1) % _REVISIONS
    for name in ("landmark", "pair"):
        last = max(len(getattr(steering, f"{name}s")) - 1, 0)
        if getattr(steering, f"{name}_index") > last:
            setattr(steering, f"{name}_index", last)


def _landmark_rows(scene: bpy.types.Scene) -> list[dict[str, Any]]:
    pair = steered_pair(scene)
    landmarks = [] if pair is None else find_landmarks(*pair)
    labels = [landmark_label(one.number) for one in landmarks]
    return [
        {**vars(one), "name": label, "label": one.name or label} for one, label in zip(landmarks, labels, strict=True)
    ]


def pair_rows(scene: bpy.types.Scene, pair: tuple[Side, Side] | None = None) -> list[dict[str, Any]]:
    """List the matched points of a pair, see `common_match`, the worst first: what the rows of the list hold."""
    halves = common_match(scene, pair)
    if halves is None or not all(half.has_same_faces() for half in halves):
        return []
    first, second = in_order(*halves)
    stored = StoredMatch.from_plain(first.kept, second.kept)
    sides = (stored.source_points, stored.answer.target_points)
    source, target = sides if first is halves[0] else sides[::-1]
    sources, targets = source.nearest_vertices, target.nearest_vertices
    weights = [points.barycentric.astype(np.float32).tolist() for points in (source, target)]  # as properties hold them
    distortion = stored.answer.point_distortion
    locked = {(one.source, one.target) for one in find_landmarks(halves[0].obj, halves[1].obj) if one.use}
    return [
        {
            "name": point_name(first.prefix, number + 1),
            "number": number + 1,
            "source": int(sources[number]),
            "target": int(targets[number]),
            "source_corners": tuple(source.corners[number].tolist()),
            "source_weights": tuple(weights[0][number]),
            "target_corners": tuple(target.corners[number].tolist()),
            "target_weights": tuple(weights[1][number]),
            "distortion": float(np.float32(distortion[number])),
            "locked": (int(sources[number]), int(targets[number])) in locked,
        }
        for number in np.argsort(-distortion, kind="stable").tolist()
        if number not in stored.left_out
    ]


def _fill(items: Any, rows: list[dict[str, Any]]) -> bool:  # noqa: ANN401 - a collection property
    """Let a collection have these rows; return whether it had others."""
    if len(items) == len(rows) and all(
        (tuple(getattr(item, name)) if isinstance(value, tuple) else getattr(item, name)) == value
        for item, row in zip(items, rows, strict=True)
        for name, value in row.items()
    ):
        return False
    while len(items) > len(rows):
        items.remove(len(items) - 1)
    while len(items) < len(rows):
        items.add()
    for item, row in zip(items, rows, strict=True):
        for name, value in row.items():
            setattr(item, name, value)
    return True
