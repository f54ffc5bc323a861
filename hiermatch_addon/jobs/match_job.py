# SPDX-License-Identifier: GPL-3.0-or-later
"""A match of two objects as a piece of work: the operator, scripts and tests drive it alike."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

from ...engine import (
    DOUBTFUL,
    MatchError,
    MatchSettings,
    Progress,
    RiggedBody,
    called_steps,
    densify_steps,
    distortion_after,
    followed_share,
    match_steps,
    paired_limb_tips,
    placed_by_map,
    within,
)
from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..properties.preferences import shape_memory
from ..properties.properties import match_settings
from ..scene.armatures import held_vertices, read_rig, without_held
from ..scene.character import SideReference, positions_of, read_surface, topology_of, vertex_count
from ..scene.pair import check_pair
from ..storage import writing
from ..storage.answer_writing import write_answer
from ..storage.contents import contents_steps
from ..storage.excluded_regions import excluded_vertices
from ..storage.landmarks import find_landmarks, landmark_array
from ..storage.stored_match import Answer, CornerPoints, Quality, StoredMatch, Written
from ..storage.vertex_maps import StoredMaps, add_maps
from .prepared_shapes import known_shapes
from .stepped_job import SteppedJob
from .verdict import advice_on, hung_on_bones, is_half

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...engine import MatchResult, Steps, SurfaceMap, TriangleMesh
    from ..properties.properties import MatchOptions
    from ..scene.character import Side
    from ..storage.contents import Content

_BY_RIGS = "The shapes have little in common: limbs were taken for the same that both rigs have in the same places."

_MATCHED = 0.98
"""Where on the bar of progress the match ends, and what is written is prepared."""


@dataclass(frozen=True)
class JobOptions:
    """What to match and what to write.

    Attributes
    ----------
    settings : MatchSettings
        The engine's settings.
    use_modifiers : bool
        Whether to match the meshes as shape keys and modifiers show them.
    alternative : int
        Number of the alternative to write, from 1, or 0 for the direct answer, which is also written if there are not
        as many.
    use_landmarks : bool
        Whether to keep to the landmarks that the two meshes have in common.
    exclude_source, exclude_target : str
        Names of the regions to leave out; empty if there are none.
    prefix : str
        What all names written start with.
    vertex_groups, match_colors, distortion, confidence : bool
        Which kinds to write; confidence only if the match has dense maps.
    """

    settings: MatchSettings
    use_modifiers: bool = False
    alternative: int = 0
    use_landmarks: bool = True
    exclude_source: str = ""
    exclude_target: str = ""
    prefix: str = "HM"
    vertex_groups: bool = True
    match_colors: bool = True
    distortion: bool = True
    confidence: bool = True

    def __post_init__(self) -> None:
        writing.check_prefix(self.prefix)

    def written(self, *, dense: bool) -> Written:
        """Say how a match is written that has dense maps, or none."""
        excluded = self.exclude_source, self.exclude_target
        kinds = self.vertex_groups, self.match_colors, self.distortion, self.confidence
        return Written(self.use_modifiers, *kinds, dense=dense, excluded=excluded)


def job_options(options: MatchOptions) -> JobOptions:
    """Read the options of a match, from an operator or from the panel's state.

    Raises
    ------
    SettingsError
        If they contradict each other, or the prefix is empty or too long.
    """
    return JobOptions(
        settings=match_settings(options),
        use_modifiers=options.use_modifiers,
        alternative=options.alternative,
        use_landmarks=options.use_landmarks,
        exclude_source=options.exclude_source,
        exclude_target=options.exclude_target,
        prefix=options.prefix,
        vertex_groups=options.write_vertex_groups,
        match_colors=options.write_colors,
        distortion=options.write_distortion,
        confidence=options.write_confidence,
    )


@dataclass(frozen=True, eq=False)
class Outcome:
    """A finished match.

    Attributes
    ----------
    result : MatchResult
        What was written.
    stored : StoredMatch
        What is kept of it in the file: all answers.
    seconds : float
        How long it took, from reading to writing.
    """

    result: MatchResult
    stored: StoredMatch
    seconds: float


@dataclass(frozen=True, eq=False)
class _Found:
    """What the engine found.

    Attributes
    ----------
    result : MatchResult
        The result.
    chosen : int
        Number of the answer to write, from 0 for the result itself.
    """

    result: MatchResult
    chosen: int

    @property
    def answers(self) -> tuple[MatchResult, ...]:
        """The result and its alternatives, with dense maps as far as they were made."""
        return (self.result, *self.result.alternatives)

    @property
    def answer(self) -> MatchResult:
        """The answer to write."""
        return self.answers[self.chosen]

    def maps(self, number: int) -> StoredMaps | None:
        """Return what is kept of the dense maps of one answer; None if they were not made."""
        found = self.answers[number]
        if found.source_to_target is None or found.target_to_source is None:
            return None
        return StoredMaps.of(found.source_to_target, found.target_to_source)


class MatchJob(SteppedJob):
    """The match of two objects, from reading them to writing on them.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again, and ends with an error if they are not what they were.  Nothing is written before `finish`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the objects are.
    source, target : bpy.types.Object or Character
        The objects, or characters of several.
    options : JobOptions
        What to match and to write.
    writes : pair of bool
        Whether source and target are to be written to: if not, they may be another file's.

    Attributes
    ----------
    progress : Progress
        How far the work is.

    Raises
    ------
    HierMatchError
        If the objects or settings do not allow a match.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        source: Side,
        target: Side,
        options: JobOptions,
        *,
        writes: tuple[bool, bool] = (True, True),
    ) -> None:
        self._start = time.perf_counter()
        self._options = options
        depsgraph = context.evaluated_depsgraph_get()  # brings world matrices up to date, too
        self._writes = writes
        check_pair(view_layer_of(context), source, target, writes=writes)
        for obj in (source, target):
            _check_points(obj, options.settings)
        self._references = (SideReference.of(source), SideReference.of(target))
        self._meshes = (
            read_surface(source, depsgraph, use_modifiers=options.use_modifiers),
            read_surface(target, depsgraph, use_modifiers=options.use_modifiers),
        )
        self._topologies = (topology_of(source), topology_of(target))
        self._positions = (positions_of(source), positions_of(target))
        self._landmarks = landmark_array(find_landmarks(source, target)) if options.use_landmarks else None
        self._excluded = (
            excluded_vertices(source, options.exclude_source),
            excluded_vertices(target, options.exclude_target),
        )
        plain = not options.use_modifiers
        self._halves = (plain and is_half(source), plain and is_half(target))
        self._hung = (hung_on_bones(source), hung_on_bones(target))
        self._known = known_shapes(shape_memory(context))
        self._found: _Found | None = None
        self._prepared: tuple[Content, Content] | None = None
        super().__init__()

    def _check(self) -> None:
        self._objects()

    def _all_steps(self) -> Steps[None]:
        """Match, and prepare what is to be written."""
        self._found = yield from within(self._match_steps(), 0.0, _MATCHED)
        self._prepared = yield from within(self._prepare_steps(self._found), _MATCHED, 1.0)

    def _match_steps(self) -> Steps[_Found]:
        """Match, and make the dense maps of an alternative if that is to be written."""
        options, (source, target) = self._options, self._meshes
        both = options.alternative > 0 and options.settings.dense
        steps = match_steps(
            source,
            target,
            options.settings,
            landmarks=self._landmarks,
            excluded=self._excluded,
            known=self._known,
        )
        end = 0.7 if both else 1.0
        result = yield from within(steps, 0.0, end)
        result = yield from within(self._by_rigs_steps(result), end, end)
        others, chosen = list(result.alternatives), options.alternative
        if chosen > len(others):
            return _Found(result, 0)
        quality = result.quality
        if not both or quality is None:
            return _Found(result, chosen)
        other = others[chosen - 1]
        points = other.source_points
        mapping = densify_steps(
            source,
            target,
            points,
            other.target_points,
            excluded=self._excluded,
            maps=(result.source_to_target, result.target_to_source),
            margin=quality.margin,
            alternatives=quality.alternatives,
        )
        dense = yield from within(mapping, 0.7, 1.0)
        placing = called_steps(placed_by_map, source, target, points, dense.source_to_target)
        images, distortion = yield from within(placing, 1.0, 1.0)
        others[chosen - 1] = replace(
            other,
            target_points=images,
            point_distortion=distortion,
            distortion=distortion_after(other.distortion, other.point_distortion, distortion),
            source_to_target=dense.source_to_target,
            target_to_source=dense.target_to_source,
            quality=dense.quality,
        )
        return _Found(replace(result, alternatives=tuple(others)), chosen)

    def _by_rigs_steps(self, result: MatchResult) -> Steps[MatchResult]:
        """Match anew by the ends of limbs, as both rigs have them, if a match is doubtful and takes them elsewhere."""
        options, quality, meshes = self._options, result.quality, self._meshes
        guided = self._landmarks is not None and len(self._landmarks)
        if quality is None or quality.confidence >= DOUBTFUL or options.use_modifiers or guided:
            return result
        bodies = [_rigged_body(each, mesh) for each, mesh in zip(self._references, meshes, strict=True)]
        if bodies[0] is None or bodies[1] is None:
            return result
        (first, held), (second, others) = bodies[0], bodies[1]
        pairs = paired_limb_tips(first, second)[: options.settings.points]
        if not len(pairs) or (share := followed_share(_maps(result), meshes, pairs)) == 1.0:
            return result
        steps = match_steps(
            *meshes,
            options.settings,
            landmarks=pairs,
            assumed=True,
            excluded=(_either(self._excluded[0], held), _either(self._excluded[1], others)),
            known=self._known,
        )
        try:
            other = yield from steps
        except MatchError:  # an end of a limb is on nothing that is matched
            return result
        better = followed_share(_maps(other), meshes, pairs) > share
        return replace(other, notes=(*other.notes, _BY_RIGS)) if better else result

    def _prepare_steps(self, found: _Found) -> Steps[tuple[Content, Content]]:
        """Prepare what is to be written of the answers."""
        options, prefix = self._options, self._options.prefix
        kept, maps = found.maps(found.chosen), None
        if kept is not None:
            yield Progress(0.0, "Preparing what is written")
            maps = kept.between(*self._meshes)
        written = options.written(dense=kept is not None)
        contents = yield from within(contents_steps(found.answer, prefix, written, maps), 0.3, 1.0)
        if kept is not None:
            others = (found.maps(number) for number in range(len(found.answers)) if number != found.chosen)
            add_maps(contents, prefix, (kept, *others))
        return contents

    @property
    def maps(self) -> StoredMaps | None:
        """The dense maps of the answer that is to be written, as they are kept; None as long as there are none."""
        return None if self._found is None else self._found.maps(self._found.chosen)

    @property
    def quality(self) -> Quality | None:
        """How far these maps can be trusted; None as long as there are none."""
        found = None if self._found is None else self._found.answer.quality
        return None if found is None else Quality.of(found)

    def finish(self) -> Outcome:
        """Write the result on both objects.

        Raises
        ------
        HierMatchError
            If the objects have changed, or the user's own vertex groups or attributes are in the way.
        """
        if self._found is None or self._prepared is None:
            raise RuntimeError("The match has not come to its end yet.")
        objects = self._unchanged_objects()
        for obj, read in zip(objects, self._topologies, strict=True):
            if topology_of(obj) != read:
                raise ObjectError(f'The faces of "{obj.name}" changed while it was being matched. Nothing was written.')
        names, prefix = (objects[0].name, objects[1].name), self._options.prefix
        stored = self._stored(self._found, names)
        write_answer((objects[0], objects[1]), stored, self._prepared, prefix, show=True)
        return Outcome(self._found.answer, stored, time.perf_counter() - self._start)

    def stored(self) -> StoredMatch:
        """Collect what is to be kept of the match, without writing it; it must have come to its end.

        Raises
        ------
        HierMatchError
            If the objects have changed.
        """
        if self._found is None:
            raise RuntimeError("The match has not come to its end yet.")
        source, target = self._unchanged_objects()
        return self._stored(self._found, (source.name, target.name))

    def _stored(self, found: _Found, names: tuple[str, str]) -> StoredMatch:
        """Collect what is kept of the match in the file."""
        options, result, notes = self._options, found.result, list(found.result.notes)
        if options.alternative > found.chosen:
            missing, count = options.alternative, len(result.alternatives)
            notes.append(f"There is no alternative {missing}, only {count}: the direct answer was written.")
        notes += self._advice(found, names)
        return StoredMatch(
            names=names,
            topologies=self._topologies,
            positions=self._positions,
            written=options.written(dense=result.source_to_target is not None),
            source_points=CornerPoints.of(result.source_points),
            answers=tuple(Answer.of(answer, answer.quality) for answer in found.answers),
            chosen=found.chosen,
            notes=tuple(notes),
        )

    def _advice(self, found: _Found, names: tuple[str, str]) -> list[str]:
        """Say what the meshes look like, and what to do then, if the match is not to be trusted."""
        quality = found.answer.quality
        if quality is None or quality.confidence >= DOUBTFUL:
            return []
        advice = advice_on(quality, names, self._meshes, halves=self._halves, hung=self._hung)
        return [advice] if advice else []

    def _unchanged_objects(self) -> list[Side]:
        """Look the objects up again and make sure that they can still be written to."""
        objects = self._objects()
        try:
            check_pair(None, *objects, writes=self._writes)
        except ObjectError as error:
            raise ObjectError(f"The match was ended, because the objects changed: {error}") from error
        return objects

    def _objects(self) -> list[Side]:
        """Look the objects up again and make sure that they still have the vertices that were read."""
        objects = [reference.found() for reference in self._references]
        for obj, mesh in zip(objects, self._meshes, strict=True):
            if vertex_count(obj) != mesh.vertex_count:
                raise ObjectError(
                    f'"{obj.name}" got another number of vertices while it was being matched. Nothing was written.'
                )
        return objects


def _rigged_body(reference: SideReference, mesh: TriangleMesh) -> tuple[RiggedBody, NDArray[np.bool_]] | None:
    """Return a body with its rig, without weights of what it holds, and which vertices that are; None without a rig."""
    side = reference.find()
    rig = None if side is None else read_rig(side)
    if side is None or rig is None:
        return None
    return RiggedBody(mesh, rig.skeleton, without_held(side, rig.weights)), held_vertices(side)


def _either(chosen: NDArray[np.bool_] | None, held: NDArray[np.bool_]) -> NDArray[np.bool_] | None:
    """Leave out what is held as well, but not all."""
    both = held if chosen is None else chosen | held
    return both if both.any() and not both.all() else chosen


def _maps(result: MatchResult) -> tuple[SurfaceMap, SurfaceMap]:
    """Return the dense maps of a match, which has some: there and back."""
    return cast("SurfaceMap", result.source_to_target), cast("SurfaceMap", result.target_to_source)


def _check_points(obj: Side, settings: MatchSettings) -> None:
    """Make sure that there are vertices enough; a dense match makes do with fewer points than it is asked for."""
    count, points = vertex_count(obj), settings.points
    if (min(settings.coarse_points, points) if settings.dense else points) > count:
        raise ObjectError(
            f'"{obj.name}" has {count} vertices, too few for {points} Points. Set Points to {count} or fewer, '
            "or subdivide the mesh."
        )
