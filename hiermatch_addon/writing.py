# SPDX-License-Identifier: GPL-3.0-or-later
"""What a match writes on objects, and how it is taken away again.

Everything new is built beside what is there under a temporary name; only when all of it stands on both objects, the
old is removed and the new takes its name.  So a failure half way leaves the objects as they were.

What was written is recorded on the mesh (where Blender keeps vertex groups and attributes alike), in the custom
property `MARKER`: per prefix, the names, what was active before, and whatever else is to be kept with them.  Nothing
else is ever removed.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from . import colors, mesh_io
from .access import mesh_of
from .errors import ObjectError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import bpy
    from numpy.typing import NDArray

__all__ = [
    "MARKER",
    "Content",
    "Correspondence",
    "Points",
    "check_names",
    "clear",
    "contents",
    "is_marked",
    "kept",
    "prefixes",
    "write",
]

MARKER = "hiermatch"
"""Name of the custom property on a mesh that records what was written."""

_TEMPORARY = " ~"
"""What the names of the new end with until the old is gone."""

_GROUP, _ATTRIBUTE = "group", "attribute"

UNREACHED = -1.0
"""Value of the distortion where no matched point has a path to."""


class Points(Protocol):
    """What of points on a surface is needed to write them; see `SurfacePoints`."""

    @property
    def corners(self) -> NDArray[np.int64]:
        """Vertices of the triangle of each point, (k, 3)."""

    @property
    def barycentric(self) -> NDArray[np.float64]:
        """Barycentric coordinates there, (k, 3)."""

    @property
    def nearest_vertices(self) -> NDArray[np.int64]:
        """The corner with the largest coordinate, (k,)."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """Where the points are, (k, 3)."""

    def __len__(self) -> int: ...


class Correspondence(Protocol):
    """What of a match is needed to write it; see `MatchResult`."""

    @property
    def source_points(self) -> Points:
        """Matched points of the source, k."""

    @property
    def target_points(self) -> Points:
        """The corresponding points of the target, k."""

    @property
    def point_distortion(self) -> NDArray[np.float64]:
        """Distortion of each point, (k,)."""

    @property
    def source_distances(self) -> NDArray[np.float64]:
        """Geodesic distance from each point to every vertex of the source, (k, n)."""

    @property
    def target_distances(self) -> NDArray[np.float64]:
        """The same on the target, (k, m)."""


@dataclass(frozen=True, eq=False)
class Content:
    """What shall stand on one object.

    Attributes
    ----------
    groups : dict
        For each vertex group its vertices (c,) and their weights (c,).
    colors : dict
        For each color attribute its linear colours, (n, 4).
    values : dict
        For each attribute of numbers its values, (n,).
    keep : dict
        Plain data to keep with it: numbers, texts, lists of numbers, and such dicts; see `kept`.
    """

    groups: dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]] = field(default_factory=dict)
    colors: dict[str, NDArray[np.float32]] = field(default_factory=dict)
    values: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    keep: dict[str, Any] = field(default_factory=dict)

    @property
    def shown(self) -> str | None:
        """The color attribute to make the active one: the first."""
        return next(iter(self.colors), None)

    @property
    def kinds(self) -> dict[str, str]:
        """What each name is: a group or an attribute."""
        attributes = dict.fromkeys([*self.colors, *self.values], _ATTRIBUTE)
        return dict.fromkeys(self.groups, _GROUP) | attributes


def contents(
    result: Correspondence, prefix: str, *, vertex_groups: bool, match_colors: bool, distortion: bool
) -> tuple[Content, Content]:
    """Prepare what a match writes on the source and on the target.

    Parameters
    ----------
    result : MatchResult or other Correspondence
        The match; its distances are used for colors and distortion only.
    prefix : str
        What every name starts with.
    vertex_groups, match_colors, distortion : bool
        Which kinds to write.

    Returns
    -------
    source, target : Content
        What to write on each.
    """
    prepared = (Content(), Content())
    sides = ((result.source_points, result.source_distances), (result.target_points, result.target_distances))
    if vertex_groups:
        for content, (points, _) in zip(prepared, sides, strict=True):
            content.groups.update(_groups(points, prefix))
    if not (match_colors or distortion):
        return prepared
    pairs = [distances[:, points.nearest_vertices] for points, distances in sides]
    reaches = colors.bandwidths(*pairs)
    # Red, green, blue and the distortion of each point, (k, 4): spread in one go.
    shown = np.column_stack([colors.match_colors(result.source_points.positions), result.point_distortion])
    worst = float(result.point_distortion.max())
    for content, (_, distances), reach in zip(prepared, sides, reaches, strict=True):
        mixed = colors.spread(shown, distances, reach)
        if match_colors:
            content.colors[f"{prefix} Match"] = colors.opaque(colors.to_linear(mixed[:, :3]))
        if distortion:
            values = mixed[:, 3]
            shades = colors.to_linear(colors.distortion_colors(values, worst))
            content.colors[f"{prefix} Distortion"] = colors.opaque(shades)
            content.values[f"{prefix} Distortion Value"] = np.where(np.isnan(values), UNREACHED, values)
    return prepared


def _groups(points: Points, prefix: str) -> dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]]:
    """Name a vertex group for each point: its corners with a positive barycentric coordinate, weighted by it."""
    groups = {}
    for number, (corners, weights) in enumerate(zip(points.corners, points.barycentric, strict=True), start=1):
        positive = weights > 0
        groups[f"{prefix}.{number:03d}"] = (corners[positive], weights[positive])
    return groups


def check_names(obj: bpy.types.Object, content: Content) -> None:
    """Make sure that nothing of the user's own stands where the match writes.

    Raises
    ------
    ObjectError
        If a vertex group or attribute of that name exists that a match did not write.
    """
    mesh = mesh_of(obj)
    ours = {name for record in _records(mesh).values() for name in record["written"]}
    present = dict.fromkeys(obj.vertex_groups.keys(), "a vertex group")
    present |= dict.fromkeys(mesh.attributes.keys(), "an attribute")
    for name in (*content.kinds, *(name + _TEMPORARY for name in content.kinds)):
        if name in present and name not in ours:
            raise ObjectError(
                f'"{obj.name}" already has {present[name]} called "{name}" that HierMatch did not write. '
                "Rename it, or choose another Prefix."
            )


def write(plan: Sequence[tuple[bpy.types.Object, Content]], prefix: str, *, show: bool = True) -> None:
    """Write on several objects: all of it, or nothing if anything fails.

    Whatever was written with the same prefix before is replaced.  What is active in the lists of vertex groups and
    attributes stays so, except for the color attribute to be shown, if one is to `show`.
    """
    before = [_Active.of(obj) for obj, _ in plan]
    with ExitStack() as undo:
        for (obj, content), active in zip(plan, before, strict=True):
            undo.callback(active.restore, obj)
            undo.callback(_remove, obj, {name + _TEMPORARY: kind for name, kind in content.kinds.items()})
            _add(obj, content)
        undo.pop_all()
    for (obj, content), active in zip(plan, before, strict=True):
        _replace(obj, content, prefix, active)
        (active.showing(content.shown) if show else active).restore(obj)
        mesh_of(obj).update()


def is_marked(mesh: bpy.types.Mesh) -> bool:
    """Return whether something was written on a mesh."""
    properties: Any = mesh
    return MARKER in properties


def prefixes(obj: bpy.types.Object) -> tuple[str, ...]:
    """Return the prefixes under which something was written on an object, oldest first."""
    properties: Any = mesh_of(obj)
    return tuple(properties[MARKER].keys()) if is_marked(mesh_of(obj)) else ()


def kept(obj: bpy.types.Object, prefix: str) -> dict[str, Any]:
    """Return the plain data that was kept on an object with what was written with a prefix; empty if there is none."""
    properties: Any = mesh_of(obj)
    if not is_marked(mesh_of(obj)) or prefix not in properties[MARKER]:
        return {}
    found = properties[MARKER][prefix].get("kept")
    return {} if found is None else found.to_dict()


def clear(obj: bpy.types.Object, prefix: str) -> bool:
    """Remove what was written on an object with a prefix; return whether there was anything."""
    mesh = mesh_of(obj)
    records = _records(mesh)
    if prefix not in records:
        return False
    record = records.pop(prefix)
    active = _Active.of(obj).without(record)
    _remove(obj, record["written"])
    active.restore(obj)
    _set_records(mesh, records)
    mesh.update()
    return True


def _add(obj: bpy.types.Object, content: Content) -> None:
    """Add everything under its temporary name."""
    mesh = mesh_of(obj)
    for name, (vertices, weights) in content.groups.items():
        mesh_io.add_vertex_group(obj, name + _TEMPORARY, vertices, weights)
    for name, rgba in content.colors.items():
        mesh_io.add_colors(mesh, name + _TEMPORARY, rgba)
    for name, values in content.values.items():
        mesh_io.add_values(mesh, name + _TEMPORARY, values)


def _replace(obj: bpy.types.Object, content: Content, prefix: str, active: _Active) -> None:
    """Remove what the prefix named before, let the new take its name, and record it."""
    mesh = mesh_of(obj)
    records = _records(mesh)
    before = active
    if prefix in records:
        before = active.without(records[prefix])
        _remove(obj, records[prefix]["written"])
    for name, kind in content.kinds.items():
        owner: Any = obj.vertex_groups if kind == _GROUP else mesh.attributes
        owner[name + _TEMPORARY].name = name
    if content.kinds:
        records[prefix] = {
            "written": content.kinds,
            "color": before.color,
            "render_color": before.render_color,
            "kept": content.keep,
        }
    else:
        records.pop(prefix, None)
    _set_records(mesh, records)


def _remove(obj: bpy.types.Object, kinds: dict[str, str]) -> None:
    """Remove the groups and attributes of these names that exist."""
    mesh = mesh_of(obj)
    for name, kind in kinds.items():
        owner: Any = obj.vertex_groups if kind == _GROUP else mesh.attributes
        found = owner.get(name)
        if found is not None:
            owner.remove(found)


def _records(mesh: bpy.types.Mesh) -> dict[str, Any]:
    """Return what was written, per prefix, oldest first."""
    properties: Any = mesh
    return properties[MARKER].to_dict() if is_marked(mesh) else {}


def _set_records(mesh: bpy.types.Mesh, records: dict[str, Any]) -> None:
    properties: Any = mesh
    if records:
        properties[MARKER] = records
    elif is_marked(mesh):
        del properties[MARKER]


@dataclass(frozen=True)
class _Active:
    """What is active in an object's lists; names, because indices move when something is added or removed."""

    group: str
    attribute: str
    color: str
    render_color: str

    @classmethod
    def of(cls, obj: bpy.types.Object) -> _Active:
        attributes = mesh_of(obj).attributes
        group, attribute = obj.vertex_groups.active, attributes.active
        return cls(
            group.name if group else "",
            attribute.name if attribute else "",
            attributes.active_color_name or "",
            attributes.default_color_name or "",
        )

    def without(self, record: dict[str, Any]) -> _Active:
        """Replace the active colours that the record's match made by those before it."""
        written: Iterable[str] = record["written"]
        return _Active(
            self.group,
            self.attribute,
            record["color"] if self.color in written else self.color,
            record["render_color"] if self.render_color in written else self.render_color,
        )

    def showing(self, color: str | None) -> _Active:
        """Make a color attribute the active one, and the one to render if there was none."""
        if color is None:
            return self
        return _Active(self.group, self.attribute, color, self.render_color or color)

    def restore(self, obj: bpy.types.Object) -> None:
        """Make active again what still exists; Blender does not always do so by itself when a layer goes."""
        attributes = mesh_of(obj).attributes
        if len(obj.vertex_groups):
            obj.vertex_groups.active_index = max(obj.vertex_groups.find(self.group), 0)
        if self.attribute in attributes:
            attributes.active = attributes[self.attribute]
        layers = [layer.name for layer in mesh_of(obj).color_attributes]
        fallback = layers[0] if layers else ""
        attributes.active_color_name = self.color if self.color in ("", *layers) else fallback
        attributes.default_color_name = self.render_color if self.render_color in ("", *layers) else fallback
