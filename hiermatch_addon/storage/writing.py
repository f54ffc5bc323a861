# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing of a match on objects, and its removal.

Everything new is built beside what is there under a temporary name; only when all of it stands on both objects, the
old is removed and the new takes its name.  So a failure half way leaves the objects as they were.

What was written is recorded on the mesh (where Blender keeps vertex groups and attributes alike), in the custom
property `MARKER`: per prefix, the names, what was active before, and whatever else is to be kept with them.  Nothing
else is ever removed.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...engine import SettingsError
from ..common.access import group_of, mesh_of
from ..common.errors import ObjectError
from ..common.phrases import not_ours
from ..scene import attribute_io, mesh_io
from ..scene.character import forget_order, keep_order, parts_of, vertex_ranges

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import bpy

    from ..scene.character import Side
    from .contents import Content

MARKER = "hiermatch"
"""Name of the custom property on a mesh that records what was written."""

LONGEST_PREFIX = 32
"""Bytes in a prefix, at most: with the longest ending a name stays below the 63 bytes that Blender allows it."""

_TEMPORARY = " ~"
"""What the names of the new end with until the old is gone."""

_GROUP, _ATTRIBUTE = "group", "attribute"


def check_prefix(prefix: str) -> None:
    """Make sure that names can start with a prefix.

    Raises
    ------
    SettingsError
        If it is empty or too long.
    """
    if not prefix.strip():
        raise SettingsError("The Prefix is empty. Enter what the names of the vertex groups shall start with.")
    if len(prefix.encode(errors="replace")) > LONGEST_PREFIX:
        raise SettingsError(
            f"The Prefix is too long. Enter one of at most {LONGEST_PREFIX} letters, or {LONGEST_PREFIX // 3} in "
            "Chinese or Japanese."
        )


def check_names(side: Side, content: Content, prefix: str) -> None:
    """Make sure that nothing else stands where a match writes with a prefix.

    Raises
    ------
    ObjectError
        If a vertex group or attribute of such a name exists that no match with this prefix wrote, or a custom property
        of the records' name that is somebody else's.
    """
    for obj, of_part in _by_part(side, content):
        _check_names(obj, of_part, prefix)


def _by_part(side: Side, content: Content) -> list[tuple[bpy.types.Object, Content]]:
    """Tell what of a content stands on which part of a side."""
    parts = parts_of(side)
    if len(parts) == 1:
        return [(parts[0], content)]
    return [
        (part, content.of_part(own, number, len(parts), part.name))
        for number, (part, own) in enumerate(zip(parts, vertex_ranges(side), strict=True))
    ]


def _check_names(obj: bpy.types.Object, content: Content, prefix: str) -> None:
    mesh = mesh_of(obj)
    properties: Any = mesh
    ours = records_of(mesh)
    if MARKER in properties and not (ours and len(ours) == len(properties[MARKER])):
        raise ObjectError(not_ours(obj.name, "a custom property", MARKER))
    writers = {name: writer for writer, record in ours.items() for name in record["written"]}
    present = dict.fromkeys(obj.vertex_groups.keys(), "a vertex group")
    present |= dict.fromkeys(mesh.attributes.keys(), "an attribute")
    wanted = _kinds(content)
    for name in (*wanted, *(name + _TEMPORARY for name in wanted)):
        if name not in present or writers.get(name) == prefix:
            continue
        if name in writers:
            raise ObjectError(
                f'"{obj.name}" already has {present[name]} called "{name}", which belongs to the match with the Prefix '
                f'"{writers[name]}". Choose another Prefix, or clear that match.'
            )
        raise ObjectError(
            f'"{obj.name}" already has {present[name]} called "{name}" that HierMatch did not write. '
            "Rename it, or choose another Prefix."
        )


def write(sides: Sequence[tuple[Side, Content]], prefix: str, *, show: bool = True) -> None:
    """Write on several sides: all of it, or nothing if anything fails.

    Whatever was written with the same prefix before is replaced.  What is active in the lists of vertex groups and
    attributes stays so, except for the color attribute to be shown, if one is to `show`.
    """
    plan = [(*one, _Active.of(one[0])) for side, content in sides for one in _by_part(side, content)]
    with ExitStack() as undo:
        for obj, content, active in plan:
            undo.callback(active.restore, obj)
            undo.callback(_remove, obj, {name + _TEMPORARY: kind for name, kind in _kinds(content).items()})
            _add(obj, content)
            undo.callback(_set_records, mesh_of(obj), {}, MARKER + _TEMPORARY)
            _set_records(mesh_of(obj), _records_with(obj, content, prefix, active), MARKER + _TEMPORARY)
        undo.pop_all()
    for obj, content, active in plan:
        _replace(obj, content, prefix, active)
        (active.showing(content.shown) if show else active).restore(obj)
        mesh_of(obj).update()


def extend(side: Side, content: Content, prefix: str) -> None:
    """Write more beside what a match has written with a prefix, if any, in place of what has the same names.

    It is recorded with the rest and goes with it.  What is active stays so.
    """
    for obj, of_part in _by_part(side, content):
        _extend(obj, of_part, prefix)


def _extend(obj: bpy.types.Object, content: Content, prefix: str) -> None:
    mesh, active = mesh_of(obj), _Active.of(obj)
    kinds = _kinds(content)
    _add(obj, content)
    _remove(obj, kinds)
    _take_names(obj, kinds)
    records = _records(mesh)
    record = records.setdefault(
        prefix, {"written": {}, "color": active.color, "render_color": active.render_color, "kept": {}}
    )
    record["written"] |= kinds
    _set_records(mesh, records)
    active.restore(obj)
    mesh.update()


def take_away(side: Side, names: Iterable[str], prefix: str) -> None:
    """Remove some of what a match has written with a prefix."""
    gone = tuple(names)
    for obj in parts_of(side):
        mesh, active = mesh_of(obj), _Active.of(obj)
        records = _records(mesh)
        written = records[prefix]["written"]
        _remove(obj, {name: written.pop(name) for name in gone if name in written})
        _set_records(mesh, records)
        active.restore(obj)
        mesh.update()


def is_marked(mesh: bpy.types.Mesh) -> bool:
    """Return whether something was written on a mesh."""
    return bool(records_of(mesh))


def prefixes(obj: bpy.types.Object) -> tuple[str, ...]:
    """Return the prefixes under which something was written on an object, oldest first."""
    return tuple(records_of(mesh_of(obj)))


def kept(obj: bpy.types.Object, prefix: str) -> Any:  # noqa: ANN401 - Blender's group of properties
    """Return what was kept on an object with what was written with a prefix; empty if there is none.

    It is Blender's own, to be read at once: `to_dict` takes all that is in it, which is much more than its few texts.
    """
    return group_of(records_of(mesh_of(obj)).get(prefix, {}), "kept")


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


def change_kept(side: Side, prefix: str, **changes: bool | str) -> None:
    """Change some of what is kept on a side with what was written with a prefix."""
    for obj in parts_of(side):
        properties: Any = mesh_of(obj)
        for name, value in changes.items():
            properties[MARKER][prefix]["kept"][name] = value


def _kinds(content: Content) -> dict[str, str]:
    """Say of each name that is to be written what it is: a group or an attribute."""
    attributes = dict.fromkeys([*content.colors, *content.values], _ATTRIBUTE)
    return dict.fromkeys(content.groups, _GROUP) | attributes


def _add(obj: bpy.types.Object, content: Content) -> None:
    """Add everything under its temporary name."""
    mesh = mesh_of(obj)
    for name, (vertices, weights) in content.groups.items():
        mesh_io.add_vertex_group(obj, name + _TEMPORARY, vertices, weights)
    for name, rgba in content.colors.items():
        mesh_io.add_colors(mesh, name + _TEMPORARY, rgba)
    for name, values in content.values.items():
        attribute_io.add_values(mesh, name + _TEMPORARY, values)


def _replace(obj: bpy.types.Object, content: Content, prefix: str, active: _Active) -> None:
    """Remove what the prefix named before, let the new take its name, and record it."""
    mesh = mesh_of(obj)
    records = _records_with(obj, content, prefix, active)
    _remove(obj, _records(mesh).get(prefix, {"written": {}})["written"])
    _take_names(obj, _kinds(content))
    _set_records(mesh, {}, MARKER + _TEMPORARY)
    _set_records(mesh, records)
    if "part" in content.keep:
        keep_order(obj)


def _records_with(obj: bpy.types.Object, content: Content, prefix: str, active: _Active) -> dict[str, Any]:
    """Return the records of an object's mesh when a content has been written with a prefix."""
    records, written = _records(mesh_of(obj)), _kinds(content)
    before = active.without(records[prefix]) if prefix in records else active
    if written or "part" in content.keep:
        records[prefix] = {
            "written": written,
            "color": before.color,
            "render_color": before.render_color,
            "kept": content.keep,
        }
    else:
        records.pop(prefix, None)
    return records


def _take_names(obj: bpy.types.Object, kinds: dict[str, str]) -> None:
    """Let everything that has a temporary name take its own."""
    for name, kind in kinds.items():
        owner: Any = obj.vertex_groups if kind == _GROUP else mesh_of(obj).attributes
        owner[name + _TEMPORARY].name = name


def _remove(obj: bpy.types.Object, kinds: dict[str, str]) -> None:
    """Remove the groups and attributes of these names that exist."""
    mesh = mesh_of(obj)
    for name, kind in kinds.items():
        owner: Any = obj.vertex_groups if kind == _GROUP else mesh.attributes
        found = owner.get(name)
        if found is not None:
            owner.remove(found)


def records_of(mesh: bpy.types.Mesh) -> dict[str, Any]:
    """Return what was written, per prefix, oldest first, as Blender keeps it; nothing of what others have put there."""
    found = group_of(mesh, MARKER).items()
    return {prefix: record for prefix, record in found if hasattr(record, "keys") and "written" in record}


def _records(mesh: bpy.types.Mesh) -> dict[str, Any]:
    """Return the same as plain data."""
    return {prefix: record.to_dict() for prefix, record in records_of(mesh).items()}


def _set_records(mesh: bpy.types.Mesh, records: dict[str, Any], name: str = MARKER) -> None:
    properties: Any = mesh
    if records:
        properties[name] = records
    elif name in properties:
        del properties[name]
        if name == MARKER:
            forget_order(mesh)


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
