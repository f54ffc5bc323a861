# SPDX-License-Identifier: GPL-3.0-or-later
"""Fitting of a rig into another body, and a better map between the two by it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, vstack

from ...geometry.laplacian import laplace_beltrami
from ...mesh.closest_points import ClosestPoints, FoundPoints, facing
from ...mesh.reflection import reflected_map, reflected_mesh, reflected_positions
from ...mesh.surface_map import SurfaceMap
from ...mesh.surface_points import SurfacePoints, interpolation_matrix
from ...mesh.triangle_mesh import TriangleMesh
from ...repair.clean_surface import CleanSurface
from ...repair.cleaning import clean
from ...runtime.arrays import Floats
from ...runtime.background import can_go_beside
from ...runtime.errors import RigError
from ...runtime.progress import Progress, Steps, at_once, within
from ...shapes.enclosing_surface import all_joined_steps
from ...shapes.known_shapes import KnownShapes
from ...shapes.proxy import MATCHED, Proxy, proxy_steps
from ..weights.skin_weights import row_shares
from .bone_fit import BoneTransforms, fit_bones, skinned
from .digit_fit import with_digits
from .digit_groups import stunted_digits, with_stiff_digits
from .fitted_rig import FittedRig
from .match_gate import Homes
from .posed_registration import PosedRegistration
from .skeleton import Skeleton

_STIFFNESS = (8e-4, 8e-4, 4e-4, 4e-4, 1.5e-4, 1.5e-4, 8e-5, 8e-5, 8e-5)
"""How stiff the body is, round after round, against distances in units of the root of the target's area."""

_WORKED = 12_000
"""About how many vertices stand for a denser mesh while the body slides."""

_FORWARD = 0.2
"""How much the map from the source counts where the bones are first sought, against that to it: where the two
contradict each other, the latter is the one that things are carried by."""

_EXPLAINED = 0.05
"""Median distance, in the same units, from where the maps have the body to where its bones have it, up to which the
rig is believed: one that does not bend where the body does would spoil the maps."""

_NEAR = 0.02
"""Distance within which the body should come to lie on the target."""

_LEAST_COVERED = 0.85
"""Least part of the target on which it should, for the rig to be believed."""


@can_go_beside
def fit_rig_steps(
    source: TriangleMesh,
    target: TriangleMesh,
    source_to_target: SurfaceMap,
    target_to_source: SurfaceMap,
    *,
    weights: csr_array,
    skeleton: Skeleton,
    refine: bool = True,
    known: KnownShapes | None = None,
) -> Steps[FittedRig]:
    """Fit a rig into another body.

    The bones are found that pose the source as the maps say.  Then, in turn, the source slides onto the target, held
    by the shape that its bones give it, and the bones are found anew: where on a limb a point lies, the bones know
    better than the surface, and where the surface is, the target knows better than the bones.  Where the maps take the
    source to its mirror image, it is that which slides.

    Parameters
    ----------
    source, target : TriangleMesh
        The bodies: the source at rest, the target as it stands.
    source_to_target, target_to_source : SurfaceMap
        Maps between all their vertices.
    weights : (n_x, b) csr_array of float
        How much each bone moves each vertex of the source; normalised here.
    skeleton : Skeleton
        The source's bones, b.
    refine : bool
        Whether to make the maps better.  Maps that were refined before, or that are exact, should be kept.
    known : KnownShapes, optional
        What the meshes were prepared to when they were matched; the result is the same without it.

    Returns
    -------
    FittedRig
        The bones in the target, and the maps.

    Raises
    ------
    RigError
        If the weights do not fit the source and the bones, or no bone moves the main part of the source.
    """
    weights = _checked(weights, source, skeleton)
    source_to_target.check(source, target)
    target_to_source.check(target, source)
    bodies, maps = (source, target), (source_to_target, target_to_source)
    if not source_to_target.mirrors(source, target):
        return (yield from _fitted_steps(bodies, maps, weights, skeleton, refine=refine, known=known))
    reflection = reflected_mesh(source)
    ends = (reflected_positions(each) for each in (skeleton.heads, skeleton.tails))
    maps = source_to_target, reflected_map(reflection, target_to_source)
    seen = Skeleton(skeleton.parents, *ends)
    fitted = yield from _fitted_steps((reflection, target), maps, weights, seen, refine=refine, known=known)
    back = reflected_map(source, fitted.target_to_source)
    # The reflection comes before what moves it: it changes the first column of each matrix.
    linear, rotations = (reflected_positions(each) for each in (fitted.linear, fitted.rotations))
    return replace(fitted, skeleton=skeleton, linear=linear, rotations=rotations, target_to_source=back)


fit_rig = at_once(fit_rig_steps)


def _fitted_steps(
    bodies: tuple[TriangleMesh, TriangleMesh],
    maps: tuple[SurfaceMap, SurfaceMap],
    weights: csr_array,
    skeleton: Skeleton,
    *,
    refine: bool,
    known: KnownShapes | None,
) -> Steps[FittedRig]:
    """Fit a rig across maps that keep left and right."""
    (source, _), (source_to_target, target_to_source) = bodies, maps
    yield Progress(0.0, "Cleaning")
    x, y = yield from within(_cleaned_steps(bodies, known), 0.0, 0.05)
    body, there = x.mesh, _on_main(y, source_to_target, x)
    back = _on_main(x, target_to_source, y)
    moving = _of_main(x, weights)
    if not moving.nnz:
        raise RigError("No bone moves the main part of the source. Give it weights, or choose another source.")
    yield Progress(0.05, "Fitting the bones")
    forward = _FORWARD * body.vertex_areas / body.area * (x.main.original_vertices >= 0)
    backward = y.mesh.vertex_areas / y.mesh.area * (y.main.original_vertices >= 0)
    positions = there.interpolate(y.mesh.triangles, y.mesh.vertices)
    bones = _Evidence(body, moving, y.mesh, skeleton).bones(positions, back, forward, backward)
    missed = np.linalg.norm(bones.posed - positions, axis=1)[x.main.original_vertices >= 0]
    if refine and np.median(missed) < _EXPLAINED * np.sqrt(y.mesh.area):
        sliding = _sliding_steps(_Pair(x, y, moving, skeleton), bones, back, maps)
        found = yield from within(sliding, 0.1, 1.0, "Fitting the rig")
        if found is not None:
            bones, positions, maps = found
    posed = skinned(source.vertices, weights, bones.linear, bones.translations)
    registered = _spread(x, posed, positions, bones.posed)
    return FittedRig(
        skeleton, weights, bones.linear, bones.translations, bones.rotations, bones.scales, posed, registered, *maps
    )


def _cleaned_steps(meshes: tuple[TriangleMesh, TriangleMesh], known: KnownShapes | None) -> Steps[list[CleanSurface]]:
    """Clean both meshes, and put one surface around each whose limbs are pieces of their own: bones move these, too."""
    bodies = []
    for mesh, name in zip(meshes, ("source", "target"), strict=True):
        shape = None if known is None else known.find(mesh, name, None)
        cleaned = clean(mesh, name) if shape is None else (shape.joined or shape).surface.cleaned
        bodies.append((cleaned, name, MATCHED))
    return (yield from all_joined_steps(bodies))


def _checked(weights: csr_array, source: TriangleMesh, skeleton: Skeleton) -> csr_array:
    """Normalise weights that fit."""
    if weights.shape != (source.vertex_count, len(skeleton)):
        raise RigError(
            f"{len(skeleton)} bones that move {source.vertex_count} vertices need weights of the shape "
            f"({source.vertex_count}, {len(skeleton)}), but got {weights.shape}."
        )
    weights = csr_array(weights, dtype=np.float64)
    if not (np.isfinite(weights.data).all() and (weights.data >= 0).all()):
        raise RigError("The weights of the bones should be finite numbers that are not negative.")
    return row_shares(weights)


def _of_main(x: CleanSurface, weights: csr_array) -> csr_array:
    """Weights of the vertices of the main part; the centres of holes have none."""
    own = x.main.original_vertices
    kept = np.flatnonzero(own >= 0)
    rows = csr_array((np.ones(len(kept)), (kept, own[kept])), shape=(len(own), weights.shape[0]))
    return csr_array(rows @ weights)


def _on_main(image: CleanSurface, surface_map: SurfaceMap, domain: CleanSurface) -> FoundPoints:
    """Name the images of the main part's vertices on the main part of the other mesh; holes' centres get any."""
    if domain.stand_in is not None:
        own = SurfacePoints.at_vertices(domain.mesh, np.arange(domain.mesh.vertex_count))
        triangles, barycentric = domain.stand_in.to_original(own.triangles, own.barycentric)
        points = SurfacePoints.from_barycentric(domain.original, triangles, barycentric)
        positions, vertices = points.interpolate(surface_map.positions), points.nearest_vertices
    else:
        vertices = np.maximum(domain.main.original_vertices, 0)
        positions = surface_map.positions[vertices]
    corners = surface_map.nearest_vertices[vertices]
    search = ClosestPoints(image.mesh)
    starts = np.where(image.vertex_parts[corners] == 0, image.vertex_images[corners], -1)
    lost = np.flatnonzero(starts < 0)
    if len(lost):
        starts[lost] = search.nearest_vertices(positions[lost])
    return search.walk(positions, starts)


def _spread(x: CleanSurface, posed: Floats, positions: Floats, posed_body: Floats) -> Floats:
    """Positions of all vertices of the original mesh: of the main part (n, 3), posed (n, 3), and as posed elsewhere."""
    whole = posed.copy()
    main = np.flatnonzero(x.vertex_parts == 0)
    if x.stand_in is not None:
        whole[main] += x.stand_in.places(main).interpolate(positions - posed_body)
    else:
        whole[main] = positions[x.vertex_images[main]]
    return whole


@dataclass(frozen=True, eq=False)
class _Evidence:
    """What says where the bones are: the body's vertices, and the target's, each with its image.

    Attributes
    ----------
    body : TriangleMesh
        The body at rest, n vertices.
    weights : (n, b) csr_array of float
        How the bones move it.
    target : TriangleMesh
        The target, m vertices.
    skeleton : Skeleton
        The bones.
    """

    body: TriangleMesh
    weights: csr_array
    target: TriangleMesh
    skeleton: Skeleton

    def bones(
        self,
        positions: Floats,
        back: FoundPoints,
        forward_shares: Floats,
        back_shares: Floats,
        *,
        begun: BoneTransforms | None = None,
    ) -> BoneTransforms:
        """Fit the bones.

        Parameters
        ----------
        positions : (n, 3) array of float
            Images of the body's vertices.
        back : FoundPoints
            Images of the target's vertices on the body, m.
        forward_shares, back_shares : (n,) and (m,) array of float
            How much each counts.
        begun : BoneTransforms, optional
            The bones before the body slid, see `fit_bones`.

        Returns
        -------
        BoneTransforms
            The bones; `posed` are the body's vertices.
        """
        evaluate = _evaluation(back, self.body)
        vertices = np.concatenate([self.body.vertices, evaluate @ self.body.vertices])
        there = np.concatenate([positions, self.target.vertices])
        shares = np.concatenate([forward_shares, back_shares])
        weights = csr_array(vstack([self.weights, evaluate @ self.weights]))
        fitted = fit_bones(vertices, there, shares, weights, self.skeleton, begun=begun)
        return replace(fitted, posed=fitted.posed[: len(positions)])


def _evaluation(points: FoundPoints | SurfacePoints, mesh: TriangleMesh) -> csr_array:
    """Matrix (k, n) that interpolates values at the vertices of a mesh at points."""
    return interpolation_matrix(points.barycentric, mesh.triangles[points.triangles], mesh.vertex_count)


class _Pair(NamedTuple):
    """The main parts of both meshes, and the rig of the first."""

    x: CleanSurface
    y: CleanSurface
    weights: csr_array
    skeleton: Skeleton


_Slid = tuple[BoneTransforms, Floats, tuple[SurfaceMap, SurfaceMap]]
"""What the sliding found: the bones, positions of the main part's vertices, and maps of the original meshes."""


def _sliding_steps(
    pair: _Pair, bones: BoneTransforms, back: FoundPoints, maps: tuple[SurfaceMap, SurfaceMap]
) -> Steps[_Slid | None]:
    """Let the body slide onto the target and find its bones, in turn; None if it does not come to lie there."""
    proxy = yield from within(proxy_steps(pair.x.mesh, _WORKED), 0.0, 0.1)
    target_proxy = yield from within(proxy_steps(pair.y.mesh, _WORKED), 0.1, 0.2)
    body, target = proxy.mesh, target_proxy.mesh
    weights = _proxy_weights(proxy, pair.weights)
    evidence = _Evidence(body, weights, target, pair.skeleton)
    found = _on_proxies(pair, back, proxy, target_proxy)
    registration = PosedRegistration(body, laplace_beltrami(body), target, Homes.of(body, target, found))
    bones = with_digits(body, weights, pair.skeleton, target, found, bones=bones)
    yield Progress(0.3, "Posing hands")
    positions, matches = bones.posed, registration.matched(bones.posed)
    shares = body.vertex_areas / body.area, target.vertex_areas / target.area
    seeking = None
    if stunted := stunted_digits(body, weights, pair.skeleton, target, matches):
        # Digits that the target lacks would crumple to lie on what there is.
        evidence = _Evidence(body, with_stiff_digits(weights, stunted), target, pair.skeleton)
        seeking = 1 - weights[:, np.concatenate([group.bones[1:] for group in stunted])].sum(axis=1)
        bones = evidence.bones(positions, matches, *shares)
        positions, matches = bones.posed, registration.matched(bones.posed)
    posed = bones.posed
    for number, stiffness in enumerate(_STIFFNESS):
        # Each third takes some tenths of a second: whoever drives this may stop in between.
        done = [Progress(0.3 + 0.5 * (number + part / 3) / len(_STIFFNESS), "Sliding") for part in (1, 2, 3)]
        positions = registration.slid(positions, posed, matches, stiffness, seeking=seeking)
        yield done[0]
        matches = registration.matched(positions)
        yield done[1]
        is_last = number == len(_STIFFNESS) - 1  # from anew, so that nothing lags behind
        bones = evidence.bones(positions, matches, *shares, begun=None if is_last else bones)
        posed = bones.posed
        yield done[2]
    covered = matches.squared_distances <= _NEAR**2 * target.area
    if shares[1][covered].sum() < _LEAST_COVERED:
        return None
    whole = skinned(pair.x.mesh.vertices, pair.weights, bones.linear, bones.translations)
    if not proxy.is_identity:
        positions = whole + _evaluation(proxy.points, body) @ (positions - posed)
    yield Progress(0.9, "Mapping every vertex")
    maps = _slid_maps(pair, positions, Homes.of(pair.x.mesh, pair.y.mesh, back), maps)
    return replace(bones, posed=whole), positions, maps


def _on_proxies(pair: _Pair, back: FoundPoints, proxy: Proxy, target_proxy: Proxy) -> FoundPoints:
    """Name the images of the vertices of the target's proxy on that of the body."""
    rows = target_proxy.vertices
    chosen = FoundPoints(back.triangles[rows], back.barycentric[rows], back.squared_distances[rows])
    if proxy.is_identity:
        return chosen
    mesh = pair.x.mesh
    places = chosen.interpolate(mesh.triangles, mesh.vertices)
    starts = proxy.points.nearest_vertices[chosen.nearest_vertices(mesh.triangles)]
    return ClosestPoints(proxy.mesh).walk(places, starts)


def _proxy_weights(proxy: Proxy, weights: csr_array) -> csr_array:
    """Carry weights of a dense mesh to the proxy's vertices: the means of those that each stands for."""
    if proxy.is_identity:
        return weights
    return row_shares(csr_array(_evaluation(proxy.points, proxy.mesh).T @ weights))


def _slid_maps(
    pair: _Pair, positions: Floats, homes: Homes, maps: tuple[SurfaceMap, SurfaceMap]
) -> tuple[SurfaceMap, SurfaceMap]:
    """Read the maps between the main parts off the body that lies on the target at positions (n, 3).

    Other parts stay where the maps had them, and all are trusted as before.
    """
    x, y = pair.x, pair.y
    size = float(np.sqrt(y.mesh.area))
    lying = ClosestPoints(x.mesh).moved(positions)
    lies_on = ClosestPoints(y.mesh)
    there = homes.on_target(lies_on, facing(lies_on, positions, lying.vertex_normals, size), positions)
    back = homes.on_body(lying, facing(lying, y.mesh.vertices, y.mesh.vertex_normals, size), y.mesh.vertices)
    return _with_main(maps[0], x, y, there), _with_main(maps[1], y, x, back)


def _with_main(surface_map: SurfaceMap, x: CleanSurface, y: CleanSurface, found: FoundPoints) -> SurfaceMap:
    """Change a map of all vertices where it takes the main part."""
    main = np.flatnonzero(x.vertex_parts == 0)
    images = SurfacePoints.from_barycentric(y.mesh, found.triangles, found.barycentric)
    triangles, barycentric = surface_map.triangles.copy(), surface_map.barycentric.copy()
    triangles[main], barycentric[main] = y.main.to_original(*x.images_of(main, images, y.mesh))
    return replace(surface_map, points=SurfacePoints.from_barycentric(y.original, triangles, barycentric))
