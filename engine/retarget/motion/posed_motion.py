# SPDX-License-Identifier: GPL-3.0-or-later
"""A skeleton in motion: how every bone is turned and where it is, from its own transforms and back to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.procrustes import nearest_rotations
from ...runtime.arrays import Bools, Floats
from ...runtime.errors import RigError
from ..rig.skeleton import Skeleton

_SCALED = 1e-5
"""From what difference from one on the scale of a bone counts."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Poses of a skeleton, f of them, in the skeleton's space.

    Attributes
    ----------
    skeleton : Skeleton
        The bones at rest, b.
    turns : (f, b, 3, 3) array of float
        How each bone is turned from rest.
    heads : (f, b, 3) array of float
        Where its head is.
    slides : (f, b, 3) array of float, optional
        How far that is from where the bone that it hangs on takes it, with the size that this one has: what moves the
        bone itself, as in a jaw or a stretched arm.  Nothing does if not given.
    """

    skeleton: Skeleton
    turns: Floats
    heads: Floats
    slides: Floats | None = None

    def __post_init__(self) -> None:
        count = len(self.skeleton)
        slides = self.heads if self.slides is None else self.slides
        shapes = {self.heads.shape, slides.shape}
        if self.turns.shape[1:] != (count, 3, 3) or shapes != {(*self.turns.shape[:2], 3)}:
            raise RigError(
                f"The motion of {count} bones needs a rotation and a place for each of them in each pose, but got "
                f"arrays of the shapes {self.turns.shape} and {self.heads.shape}."
            )
        if not all(np.isfinite(values).all() for values in (self.turns, self.heads, slides)):
            raise RigError("The motion has a pose with a number that is not finite.")

    def __len__(self) -> int:
        return len(self.turns)

    def __repr__(self) -> str:
        return f"<Motion: {len(self)} poses of {len(self.skeleton)} bones>"

    @property
    def tails(self) -> Floats:
        """Where the tails of the bones are, (f, b, 3)."""
        return self.heads + np.einsum("fbij,bj->fbi", self.turns, self.skeleton.axes)

    @classmethod
    def joined(cls, parts: Sequence[Motion]) -> Motion:
        """Play motions of one skeleton one after another."""
        turns, heads = (np.concatenate([getattr(part, name) for part in parts]) for name in ("turns", "heads"))
        slides = [np.zeros_like(part.heads) if part.slides is None else part.slides for part in parts]
        return cls(parts[0].skeleton, turns, heads, np.concatenate(slides))

    def moved(self, transforms: Floats) -> Motion:
        """Move the whole skeleton in each pose by a similarity, (f, 4, 4), of which bones take the rotation."""
        linear = transforms[:, :3, :3]
        turns = nearest_rotations(linear)[:, None] @ self.turns
        heads = np.einsum("fij,fbj->fbi", linear, self.heads) + transforms[:, None, :3, 3]
        slides = None if self.slides is None else np.einsum("fij,fbj->fbi", linear, self.slides)
        return Motion(self.skeleton, turns, heads, slides)


@dataclass(frozen=True, eq=False)
class LocalTransforms:
    """Poses as a rig stores them: the transform of each bone against its parent.

    Attributes
    ----------
    rotations : (f, b, 3, 3) array of float
        In the axes of the bone at rest.
    locations : (f, b, 3) array of float
        In the same axes, or in those of its parent.
    """

    rotations: Floats
    locations: Floats

    def __repr__(self) -> str:
        poses, bones = self.locations.shape[:2]
        return f"<LocalTransforms: {poses} poses of {bones} bones>"


def posed_motion(skeleton: Skeleton, rest: Floats, basis: Floats) -> Motion:
    """Pose a skeleton: forward kinematics.

    Parameters
    ----------
    skeleton : Skeleton
        The bones at rest, b.
    rest : (b, 4, 4) array of float
        Axes and head of each at rest.
    basis : (f, b, 4, 4) array of float
        What each is transformed by in its own axes: scale is handed on to children as well.

    Returns
    -------
    Motion
        The poses.
    """
    posed = np.empty_like(basis)
    inverse = np.linalg.inv(rest)
    for bone in skeleton.order:
        parent = skeleton.parents[bone]
        own = rest[bone] @ basis[:, bone]
        posed[:, bone] = own if parent < 0 else posed[:, parent] @ (inverse[parent] @ own)
    return motion_of_matrices(skeleton, rest, posed)


def motion_of_matrices(skeleton: Skeleton, rest: Floats, posed: Floats) -> Motion:
    """Take poses from the transforms of the bones.

    Parameters
    ----------
    skeleton : Skeleton
        The bones at rest, b.
    rest : (b, 4, 4) array of float
        Axes and head of each at rest.
    posed : (f, b, 4, 4) array of float
        The same in each pose, with its size.

    Returns
    -------
    Motion
        The poses.
    """
    inverse = np.linalg.inv(rest)
    turns, heads = posed[..., :3, :3] @ inverse[:, :3, :3], posed[..., :3, 3].copy()
    slides, hanging = np.zeros_like(heads), np.flatnonzero(skeleton.parents >= 0)
    parents = skeleton.parents[hanging]
    offsets = skeleton.heads[hanging] - skeleton.heads[parents]
    slides[:, hanging] = heads[:, hanging] - heads[:, parents] - np.einsum("fbij,bj->fbi", turns[:, parents], offsets)
    scaled = np.abs(np.linalg.norm(turns, axis=-2) - 1).max(axis=-1) > _SCALED
    if scaled.any():
        turns[scaled] = nearest_rotations(turns[scaled])
    return Motion(skeleton, turns, heads, slides)


def local_transforms(
    motion: Motion, axes: Floats, inherits: Bools | None = None, local: Bools | None = None
) -> LocalTransforms:
    """Find the transforms of the bones against their parents: the inverse of `posed_motion`.

    Parameters
    ----------
    motion : Motion
        The poses.
    axes : (b, 3, 3) array of float
        Axes of the bones at rest, as columns.
    inherits : (b,) array of bool, optional
        Which bones turn with their parents; all if not given.
    local : (b,) array of bool, optional
        Which have their locations in axes of their own, the others in those of their parents; all if not given.

    Returns
    -------
    LocalTransforms
        The transforms.
    """
    skeleton = motion.skeleton
    rotations, locations = np.empty_like(motion.turns), np.empty_like(motion.heads)
    for bone, parent in enumerate(skeleton.parents):
        carrier, place, own = np.eye(3), skeleton.heads[bone], axes[bone]
        if local is not None and not local[bone]:
            own = axes[parent] if parent >= 0 else np.eye(3)
        if parent >= 0:
            carrier = motion.turns[:, parent]
            offset = skeleton.heads[bone] - skeleton.heads[parent]
            place = motion.heads[:, parent] + carrier @ offset
        locations[:, bone] = np.einsum("...ji,...j->...i", carrier @ own, motion.heads[:, bone] - place)
        if parent >= 0 and inherits is not None and not inherits[bone]:
            carrier = np.eye(3)
        rotations[:, bone] = np.swapaxes(carrier @ axes[bone], -1, -2) @ motion.turns[:, bone] @ axes[bone]
    return LocalTransforms(rotations, locations)
