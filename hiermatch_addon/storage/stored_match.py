# SPDX-License-Identifier: GPL-3.0-or-later
"""A match as it is kept in the file: all answers, in plain numbers and texts.

Each of the two meshes keeps its own points, the source also what both have in common.  They name each other by a key
that no renaming, saving or undoing changes.  The dense maps are kept beside it, in attributes: see `vertex_maps`.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import DIRECT, MIRRORED, MatchQuality, exchanged_sentence

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from ...engine import MatchResult, SurfacePoints


@dataclass(frozen=True)
class Written:
    """How a match is written.

    Attributes
    ----------
    use_modifiers : bool
        Whether the meshes were read as shape keys and modifiers show them.
    vertex_groups, match_colors, distortion, confidence : bool
        Which kinds are written.
    dense : bool
        Whether the meshes keep dense maps.
    excluded : pair of str
        Names of the regions of source and target that were left out; exported files do not have them.
    """

    use_modifiers: bool
    vertex_groups: bool
    match_colors: bool
    distortion: bool
    confidence: bool = False  # what a file of an older version says nothing of was not written
    dense: bool = False
    excluded: tuple[str, str] = ("", "")


@dataclass(frozen=True, eq=False)
class CornerPoints:
    """Points on a mesh, by the vertices between which they lie; so they move with the mesh.

    Attributes
    ----------
    corners : (k, 3) array of int
        The vertices of the triangle of each point.
    barycentric : (k, 3) array of float
        Its barycentric coordinates there.
    """

    corners: NDArray[np.int64]
    barycentric: NDArray[np.float64]

    @classmethod
    def of(cls, points: SurfacePoints) -> CornerPoints:
        """Take what is stored of points."""
        return cls(points.corners, points.barycentric)

    @property
    def nearest_vertices(self) -> NDArray[np.int64]:
        """The corner with the largest coordinate, (k,)."""
        return np.take_along_axis(self.corners, self.barycentric.argmax(axis=1)[:, None], axis=1)[:, 0]

    def to_plain(self) -> dict[str, Any]:
        """Return flat arrays of the two number types that Blender stores."""
        return {
            "corners": self.corners.ravel().astype(np.int32),
            "barycentric": np.ascontiguousarray(self.barycentric, np.float64).ravel(),
        }

    @classmethod
    def from_plain(cls, plain: Mapping[str, Any]) -> CornerPoints:
        """Undo `to_plain`."""
        return cls(
            np.array(plain["corners"], np.int64).reshape(-1, 3),
            np.array(plain["barycentric"], np.float64).reshape(-1, 3),
        )


class Quality(MatchQuality):
    """How far the dense maps of an answer can be trusted, as files keep it."""

    @classmethod
    def of(cls, quality: MatchQuality) -> Quality:
        """Take the engine's verdict, with numbers that files can hold."""
        known = {field.name: getattr(quality, field.name) for field in fields(cls)}
        plain: dict[str, Any] = {n: v if v is None or isinstance(v, (str, int)) else float(v) for n, v in known.items()}
        return cls(**plain)

    @property
    def reverse(self) -> Quality:
        """The same with source and target exchanged."""
        shares = self.coverage, self.source_coverage
        sentence = exchanged_sentence(self.sentence, shares)
        return replace(self, source_coverage=shares[0], coverage=shares[1], sentence=sentence)

    def to_plain(self) -> dict[str, Any]:
        """Return what is known."""
        return {name: value for name, value in vars(self).items() if value is not None}

    @classmethod
    def from_plain(cls, plain: Mapping[str, Any]) -> Quality:
        """Undo `to_plain`."""
        return cls(**{"margin": None, **_known(cls, plain), "alternatives": int(plain.get("alternatives", 0))})


@dataclass(frozen=True, eq=False)
class Answer:
    """One of the answers.

    Attributes
    ----------
    name : str
        What it is called among them: "direct", "mirrored", "turned 1" and so on.
    target_points : CornerPoints
        Where the source's points are on the target.
    point_distortion : (k,) array of float
        Distortion of each point.
    distortion : float
        Distortion of the whole.
    orientation : float
        From 1, left stays left, to -1, the answer mirrors.
    proven : bool
        Whether no coarse match has less distortion.
    gap : float
        By how much, at most, the coarse match can be worse than the best one.
    quality : Quality or None
        How far its dense maps can be trusted; None if they were not made.
    refined : bool
        Whether they were made better with a rig since: once is enough.
    """

    name: str
    target_points: CornerPoints
    point_distortion: NDArray[np.float64]
    distortion: float
    orientation: float
    proven: bool
    gap: float
    quality: Quality | None = None
    refined: bool = False

    @classmethod
    def of(cls, result: MatchResult, quality: MatchQuality | None = None) -> Answer:
        """Take what is stored of a result, and of the quality of its maps."""
        coarse = result.coarse
        return cls(
            result.name,
            CornerPoints.of(result.target_points),
            result.point_distortion,
            result.distortion,
            result.orientation,
            coarse.proven,
            1 - coarse.lower_bound / coarse.cost if coarse.cost > 0 else 0.0,
            None if quality is None else Quality.of(quality),
        )

    def to_plain(self) -> dict[str, Any]:
        """Return all but the name and the points on the target."""
        return {
            "point_distortion": np.ascontiguousarray(self.point_distortion, np.float64),
            "distortion": float(self.distortion),
            "orientation": float(self.orientation),
            "proven": bool(self.proven),
            "gap": float(self.gap),
            "refined": bool(self.refined),
        } | ({} if self.quality is None else {"quality": self.quality.to_plain()})

    @classmethod
    def from_plain(cls, name: str, plain: Mapping[str, Any], points: Mapping[str, Any]) -> Answer:
        """Undo `to_plain`."""
        numbers = _known(cls, plain)
        distortion = np.array(numbers.pop("point_distortion"), np.float64)
        quality = numbers.pop("quality", None)
        return cls(
            name,
            CornerPoints.from_plain(points),
            distortion,
            **numbers,
            quality=None if quality is None else Quality.from_plain(quality),
        )


@dataclass(frozen=True, eq=False)
class StoredMatch:
    """A match of two objects with all that is needed to write any of its answers.

    Attributes
    ----------
    names : tuple of str
        Names of source and target when they were matched.
    topologies, positions : tuple of str
        What `mesh_io.topology` and `mesh_io.position_digest` said of them; positions may be empty if they are not
        known, in a file of an older version.
    written : Written
        How it is written.
    source_points : CornerPoints
        The matched points.
    answers : tuple of Answer
        The direct one, and its alternatives.
    chosen : int
        Number of the one that is written, from 0.
    notes : tuple of str
        What the user should know.
    swapped : bool
        Whether the user exchanged source and target since: what is called the source here is shown as the target.
    left_out : tuple of int
        Numbers, from 0, of the points that the user took away: they get no vertex groups.
    """

    names: tuple[str, str]
    topologies: tuple[str, str]
    positions: tuple[str, str]
    written: Written
    source_points: CornerPoints
    answers: tuple[Answer, ...]
    chosen: int
    notes: tuple[str, ...]
    swapped: bool = False
    left_out: tuple[int, ...] = ()

    @property
    def answer(self) -> Answer:
        """The answer that is written."""
        return self.answers[self.chosen]

    @property
    def order(self) -> tuple[int, ...]:
        """Numbers of the answers in the order in which their dense maps are kept: the one that is written first."""
        return (self.chosen, *(number for number in range(len(self.answers)) if number != self.chosen))

    @property
    def turned(self) -> int:
        """How many alternatives keep left and right, as the direct answer does: they are as likely."""
        return sum(answer.name not in (DIRECT, MIRRORED) for answer in self.answers)

    @property
    def margin(self) -> float | None:
        """By how much the direct answer is more credible than the others that keep left and right; None if by far."""
        quality = self.answers[0].quality
        return None if quality is None else quality.margin

    @property
    def told(self) -> tuple[Quality | None, tuple[str, ...]]:
        """How far the answer that is written can be trusted, and the notes, as source and target are called now."""
        if not self.swapped:
            return self.answer.quality, self.notes
        return self.answer.quality and self.answer.quality.reverse, tuple(map(_exchanged, self.notes))

    def with_answer(self, answer: Answer) -> StoredMatch:
        """Return the same with another answer in the place of the one that is written."""
        answers = list(self.answers)
        answers[self.chosen] = answer
        return replace(self, answers=tuple(answers))

    def as_refined(self) -> StoredMatch:
        """Return the same with the maps of the answer that is written called refined."""
        return self.with_answer(replace(self.answer, refined=True))

    @property
    def key(self) -> str:
        """A text that both meshes carry, and that is the same for the same direct answer between the same objects only.

        The points of its alternatives move when they are written for the first time.
        """
        told = (*self.names, *self.topologies, str(len(self.answers)))
        digest = hashlib.blake2b("\0".join(told).encode(), digest_size=16)
        for points in (self.source_points, self.answers[0].target_points):
            for numbers in points.to_plain().values():
                digest.update(numbers.tobytes())
        return digest.hexdigest()

    def to_plain(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return what the source and what the target keep."""
        names = {"source": self.names[0], "target": self.names[1]}
        common = {"key": self.key, "names": names, "chosen": self.chosen, "swapped": self.swapped}
        source = {
            "role": "source",
            "topology": self.topologies[0],
            "positions": self.positions[0],
            "points": self.source_points.to_plain(),
            "answers": {answer.name: answer.to_plain() for answer in self.answers},
            "written": dict(vars(self.written)),
            "notes": "\n".join(self.notes),
            "left_out": " ".join(map(str, self.left_out)),  # Blender cannot keep an empty list of numbers
        }
        target = {
            "role": "target",
            "topology": self.topologies[1],
            "positions": self.positions[1],
            "points": {answer.name: answer.target_points.to_plain() for answer in self.answers},
        }
        return common | source, common | target

    @classmethod
    def from_plain(cls, source: Mapping[str, Any], target: Mapping[str, Any]) -> StoredMatch:
        """Undo `to_plain`."""
        written = source["written"]
        return cls(
            names=(source["names"]["source"], source["names"]["target"]),
            topologies=(source["topology"], target["topology"]),
            positions=(source.get("positions", ""), target.get("positions", "")),
            written=Written(**_known(Written, written) | {"excluded": tuple(written.get("excluded", ("", "")))}),
            source_points=CornerPoints.from_plain(source["points"]),
            answers=tuple(
                Answer.from_plain(name, plain, target["points"][name]) for name, plain in source["answers"].items()
            ),
            chosen=source.get("chosen", int(source.get("mirrored", False))),
            notes=tuple(source["notes"].splitlines()),
            swapped=source.get("swapped", False),
            left_out=tuple(int(number) for number in source.get("left_out", "").split()),
        )


def _known(cls: type[Any], plain: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a class has fields for: a later version may keep more."""
    names = {field.name for field in fields(cls)}
    return {name: value for name, value in plain.items() if name in names}


def _exchanged(note: str) -> str:
    """Call the source in a note the target, and the target the source, but not in names."""
    others = {"source": "target", "target": "source"}
    return re.sub(r'"[^"]*"|\b(?:source|target)\b', lambda found: others.get(found[0], found[0]), note)
