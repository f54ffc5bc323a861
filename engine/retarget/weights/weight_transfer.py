# SPDX-License-Identifier: GPL-3.0-or-later
"""Skin weights, carried from one mesh to another and put in with those that are there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, hstack

from ...mesh.connectivity.welded_parts import WeldedParts
from ...mesh.surface_map import SurfaceMap
from ...mesh.triangle_mesh import TriangleMesh
from ...runtime.arrays import Bools
from ...runtime.background import can_go_beside
from ...runtime.errors import MatchError
from ...runtime.progress import Progress, Steps
from .loose_weights import with_loose_parts
from .rigid_parts import with_rigid_parts, with_single_bones
from .skin_weights import carried, limited, mixed, normalised, pruned, row_sums, with_rows
from .soft_joints import with_soft_joints
from .weight_filling import filled
from .weight_rejection import torn_weights

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class CarriedWeights:
    """Weights that were carried across a map.

    Attributes
    ----------
    weights : (m, g) csr_array of float
        The weights.
    torn : (m,) array of bool
        Vertices that the map tears away from their neighbours; theirs were filled in from around them.
    """

    weights: csr_array
    torn: Bools

    def __repr__(self) -> str:
        return f"<CarriedWeights: {self.weights.shape[0]} vertices, {self.weights.shape[1]} groups>"


@dataclass(frozen=True, eq=False)
class Columns:
    """What is what among the g columns of weights.

    Attributes
    ----------
    locked : (g,) array of bool
        They stay as they are.
    new : (g,) array of bool
        They get the carried weights.
    shared : (g,) array of bool
        Those of bones: a vertex has one whole to share out between them.
    yielding : bool
        Whether the shared columns that are neither new nor locked give way to the new ones.
    """

    locked: Bools
    new: Bools
    shared: Bools
    yielding: bool = False

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"


@can_go_beside
def carry_weights_steps(
    weights: csr_array,
    source: TriangleMesh,
    target: TriangleMesh,
    target_to_source: SurfaceMap,
    *,
    telling: Bools | None = None,
    fill: bool = True,
    fill_alone: bool = False,
    rigid: bool = True,
    pieces: NDArray[np.int8] | None = None,
) -> Steps[CarriedWeights]:
    """Carry weights across a map.

    Vertices at a seam that the target was cut open at, as for UVs, are one point and get the same weights.  Where the
    source is in plates and the target is not, weights pass over gradually between them.

    Parameters
    ----------
    weights : (n, g) csr_array of float
        Weights at the vertices of the source.
    source, target : TriangleMesh
        The meshes.
    target_to_source : SurfaceMap
        Map of the m vertices of the target to the source.
    telling : (g,) array of bool, optional
        The columns that tell whether neighbours move together: those of bones; all if not given.
    fill : bool
        Whether vertices that the map tears away from their neighbours take the weights around them, those between
        plates of the source pass over gradually, and loose parts of which the map is not sure are evened out.
    fill_alone : bool
        Whether vertices that have no partner on the source take the weights around them, too.
    rigid : bool
        Whether loose parts move as one whose counterparts do.
    pieces : (m,) array of int, optional
        What is known of the loose parts: 1 on vertices of one that moves by one bone, -1 of one that never moves as
        one, 0 elsewhere.  More vertices outvote fewer.

    Yields
    ------
    Progress
        How far it is.

    Returns
    -------
    CarriedWeights
        The weights at the vertices of the target.

    Raises
    ------
    MatchError
        If weights, surfaces and map do not belong together.
    """
    target_to_source.check(target, source)
    if weights.shape[0] != source.vertex_count:
        raise MatchError(f"There are weights of {weights.shape[0]} vertices, but the source has {source.vertex_count}.")
    yield Progress(0.0, "Carrying weights")
    result = carried(weights, target_to_source)
    torn = np.zeros(len(target_to_source), bool)
    parts = WeldedParts.of(target)
    marks = np.zeros(parts.part_count) if pieces is None else np.bincount(parts.vertex_labels, pieces)
    source_parts = WeldedParts.of(source)
    if rigid:
        result = with_rigid_parts(result, parts, weights, source_parts, target_to_source, free=marks < 0)
    if fill:
        result = with_soft_joints(result, parts, source_parts, target_to_source)
    result = with_single_bones(result, parts, marks > 0, telling)
    if fill:
        yield Progress(0.2, "Looking for torn vertices")
        bones = result if telling is None else csr_array(result[:, telling])
        torn = torn_weights(bones, target_to_source, parts, source)
        yield Progress(0.5, "Filling in weights")
        result = filled(result, ~torn, parts)
        result = with_loose_parts(result, target_to_source.confidence, parts)
    if fill_alone:
        result = filled(result, target_to_source.has_partner, parts)
    if parts.seams:
        result = csr_array((parts.means @ result)[parts.welded])
    return CarriedWeights(result, torn)


def put_in(
    before: csr_array,
    new: csr_array,
    columns: Columns,
    *,
    factor: float = 1.0,
    add: bool = False,
    threshold: float = 0.0,
    limit: int = 0,
    normalise: bool = True,
) -> csr_array:
    """Put new weights in with those that are there.

    Parameters
    ----------
    before, new : (m, g) csr_array of float
        Weights that are there, and those to put in.
    columns : Columns
        What is what among them.
    factor : float
        How much the new ones count, 0 to 1.
    add : bool
        Whether they are added to what is there and do not replace it.
    threshold : float
        Weights below it are dropped, but for the largest of a vertex.
    limit : int
        How many of the shared columns a vertex may have weights in; 0 for any number.
    normalise : bool
        Whether the shared columns are to sum to one at each vertex.

    Returns
    -------
    (m, g) csr_array of float
        The weights as they are to be then.
    """
    fixed = columns.locked | ~columns.new
    result = mixed(before, new, factor, add=add, locked=fixed)
    shared, others = np.flatnonzero(columns.shared), np.flatnonzero(~columns.shared)
    bones, fixed_bones = csr_array(result[:, shared]), fixed[shared]
    rest = csr_array(result[:, others])
    if threshold > 0:
        bones = pruned(bones, threshold, locked=fixed_bones)
        # A mask is no share of anything: what is tiny there may go, and be it the only one.
        kept = rest.data * ((rest.data >= threshold) | fixed[others][rest.indices])
        rest = csr_array((kept, rest.indices, rest.indptr), rest.shape)
    if limit > 0:
        bones = limited(bones, limit, locked=fixed_bones)
    if normalise and len(shared):
        locked = columns.locked[shared]
        bones = _given_way(bones, fixed_bones, locked) if columns.yielding else normalised(bones, locked=fixed_bones)
    order = np.argsort(np.concatenate([shared, others]), kind="stable")
    joined = csr_array(hstack([bones, rest], format="csr")[:, order])
    joined.eliminate_zeros()
    return joined


def _given_way(bones: csr_array, fixed: Bools, locked: Bools) -> csr_array:
    """Let the columns that are fixed but not locked make room for those that are not fixed."""
    result = normalised(bones, locked=~fixed | locked)
    over = np.flatnonzero(row_sums(result) > 1 + _ROUNDING)
    return with_rows(result, over, normalised(csr_array(result[over]), locked=locked))
