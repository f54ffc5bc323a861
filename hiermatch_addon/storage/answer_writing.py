# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing of another answer, or of other maps, of a match that two meshes keep."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...engine import Progress, called_steps, distortion_after, placed_by_map, within
from . import writing
from .contents import Restored, contents_steps
from .stored_match import CornerPoints, Quality
from .vertex_maps import add_maps, place_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...engine import DenseMatch, Steps, TriangleMesh
    from ..scene.character import Side
    from .contents import Content
    from .stored_match import StoredMatch
    from .vertex_maps import StoredMaps


def restored(stored: StoredMatch, meshes: tuple[TriangleMesh, TriangleMesh]) -> Restored:
    """Put the points of the chosen answer on the meshes, without measuring anything there."""
    answer = stored.answer
    source, target = place_points(meshes[0], stored.source_points), place_points(meshes[1], answer.target_points)
    return Restored(source, target, answer.point_distortion)


def following_steps(
    stored: StoredMatch, meshes: tuple[TriangleMesh, TriangleMesh], dense: DenseMatch, *, proven: bool
) -> Steps[StoredMatch]:
    """Let the points of the chosen answer lie where new dense maps take them; `proven` is what is said of it then."""
    answer = stored.answer
    points = restored(stored, meshes).source_points
    images, distortion = yield from called_steps(placed_by_map, *meshes, points, dense.source_to_target)
    return stored.with_answer(
        replace(
            answer,
            target_points=CornerPoints.of(images),
            point_distortion=distortion,
            distortion=distortion_after(answer.distortion, answer.point_distortion, distortion),
            proven=proven,
            quality=Quality.of(dense.quality),
            refined=False,
        )
    )


def mapped_contents_steps(
    stored: StoredMatch,
    meshes: tuple[TriangleMesh, TriangleMesh],
    prefix: str,
    shown: StoredMaps,
    others: Sequence[StoredMaps | None],
) -> Steps[tuple[Content, Content]]:
    """Prepare the chosen answer with its dense maps, and those of the others as far as they were made, in order."""
    yield Progress(0.0, "Preparing what is written")
    maps = shown.between(*meshes)
    steps = contents_steps(restored(stored, meshes), prefix, stored.written, maps, left_out=stored.left_out)
    prepared = yield from within(steps, 0.3, 1.0)
    add_maps(prepared, prefix, (shown, *others))
    return prepared


def write_answer(
    objects: tuple[Side, Side],
    stored: StoredMatch,
    prepared: tuple[Content, Content],
    prefix: str,
    *,
    show: bool = False,
) -> None:
    """Write it in place of what the match wrote before, and leave what is shown as it is unless it is to `show`.

    Raises
    ------
    ObjectError
        If the user's own vertex groups or attributes are in the way; nothing is written then.
    """
    for obj, content, kept in zip(objects, prepared, stored.to_plain(), strict=True):
        writing.check_names(obj, content, prefix)
        content.keep.update(kept)
    writing.write(list(zip(objects, prepared, strict=True)), prefix, show=show)
