# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetrising of values on one mesh, across the map to its own mirror image, in any pose and topology."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np
from scipy.sparse import csr_array, hstack

from ...engine import Progress, Symmetriser, called_steps, symmetry_map_steps, within
from ..common.access import mesh_of, view_layer_of
from ..common.errors import ObjectError
from ..common.phrases import counted
from ..common.side_names import flipped_name, partners, side_of
from ..jobs.stepped_job import SteppedJob
from ..jobs.transfer import TransferReport
from ..jobs.verdict import asymmetry_note
from ..scene.attribute_io import attribute_layouts, read_attribute, write_attribute
from ..scene.character import ReadSide
from ..scene.deform_layer import check_weights_writable, read_weights, write_weights
from ..scene.mesh_io import corner_vertices, read_mesh, vertex_positions
from ..scene.pair import check_object
from ..scene.shape_key_io import (
    KeySettings,
    add_keys,
    check_keys_writable,
    keys_of,
    linear_part,
    locked_keys,
    read_offsets,
    shape_key_names,
)
from ..storage.written_names import written_names
from .finite_values import leave_out_broken
from .wrap import wrap_key_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from .options.symmetrise import SymmetriseSettings


class SymmetriseJob(SteppedJob):
    """Makes one mesh symmetric; a `Job`.

    Parameters
    ----------
    context : bpy.types.Context
        Where the object is.
    obj : bpy.types.Object
        The mesh object.
    settings : SymmetriseSettings
        What is made symmetric.

    Attributes
    ----------
    progress : Progress
        How far the work is.
    seconds : float
        How long it took, once finished.
    found : DenseMatch
        The left-right map, once all is computed.

    Raises
    ------
    ObjectError
        If the object cannot be read or written, or carries nothing that could be made symmetric.
    """

    def __init__(self, context: bpy.types.Context, obj: bpy.types.Object, settings: SymmetriseSettings) -> None:
        self._start = time.perf_counter()
        check_object(view_layer_of(context), obj)
        check_weights_writable(obj)
        self._object = ReadSide.of(obj)
        self._parts: list[_Weights | _Keys | _Colors] = []
        if settings.weights:
            self._parts.append(_Weights(obj, create=settings.create))
        if settings.keys:
            self._parts.append(_Keys(context, obj, create=settings.create))
        if settings.colors:
            self._parts.append(_Colors(obj))
        self._notes = [note for part in self._parts for note in part.notes]
        if not any(part.names for part in self._parts):
            nothing = (
                f'"{obj.name}" carries nothing of what is to be made symmetric: no vertex groups, shape keys or color '
                "attributes. Choose another object, or turn more of them on."
            )
            raise ObjectError(self._notes[0] if self._notes else nothing)
        self._mesh = read_mesh(obj, context.evaluated_depsgraph_get(), use_modifiers=False)
        self._hints = _hints(obj) * (1.0 if settings.side == "LEFT" else -1.0)
        self.seconds = 0.0
        super().__init__()

    def finish(self) -> TransferReport:
        """Write everything.

        Raises
        ------
        ObjectError
            If the object has changed since it was read.
        """
        obj = cast("bpy.types.Object", self._object.unchanged())
        check_object(None, obj)
        done = [part.write(obj) for part in self._parts if part.names]
        self.seconds = time.perf_counter() - self._start
        return TransferReport(", ".join(done), tuple(filter(None, self._notes)))

    def _check(self) -> None:
        self._object.found()

    def _all_steps(self) -> Steps[None]:
        """Find the mirror images, and compute what is to be written."""
        self.found = yield from within(symmetry_map_steps(self._mesh), 0.0, 0.9)
        self._notes.append(asymmetry_note(self._object.name, self.found.quality))
        yield Progress(0.9, "Telling the sides apart")
        telling = called_steps(Symmetriser.of, self._mesh, self.found.source_to_target, self._hints)
        symmetriser = yield from within(telling, 0.9, 0.95)
        yield Progress(0.95, "Mirroring")
        for part in self._parts:
            if part.names:
                part.compute(symmetriser)


class _Weights:
    """The weights of the vertex groups that are neither locked nor a match's, nor without a partner."""

    notes: Sequence[str] = ()

    def __init__(self, obj: bpy.types.Object, *, create: bool) -> None:
        ours = written_names(obj)
        locked = {group.name for group in obj.vertex_groups if group.lock_weight}
        free = [name for name in obj.vertex_groups.keys() if name not in ours | locked]  # noqa: SIM118 - not a dict
        missing = [flipped_name(name) for name in free if flipped_name(name) not in obj.vertex_groups]
        if create:
            free += missing
        self.names = [name for name in free if flipped_name(name) in free]
        read = read_weights(obj)
        read = csr_array(hstack([read, csr_array((read.shape[0], 1))], format="csr"))  # the last for missing groups
        self._weights = csr_array(read[:, np.array([obj.vertex_groups.find(name) for name in self.names], np.int64)])

    def compute(self, symmetriser: Symmetriser) -> None:
        """Make them symmetric."""
        self._weights = symmetriser.weights(self._weights, partners(self.names))

    def write(self, obj: bpy.types.Object) -> str:
        """Write them."""
        write_weights(obj, self.names, self._weights)
        return counted(len(self.names), "vertex group")


class _Keys:
    """The shape keys that are not locked nor wrap the whole onto another mesh; those of one side only get a partner."""

    def __init__(self, context: bpy.types.Context, obj: bpy.types.Object, *, create: bool) -> None:
        wraps, locked = wrap_key_name(""), locked_keys(obj)
        self.names = [name for name in shape_key_names(obj) if not (name.startswith(wraps) or name in locked)]
        self.notes: Sequence[str] = ()
        if not self.names:
            return
        check_keys_writable(obj, self.names)
        moves = dict(zip(self.names, read_offsets(obj, self.names, from_reference=()), strict=True))
        self.notes, self.names = leave_out_broken(moves, obj), list(moves)
        blocks = cast("bpy.types.Key", keys_of(obj)).key_blocks
        settings = [KeySettings.of(blocks[name], ()) for name in self.names]
        present = {key.name for key in blocks}
        self._missing = [one for one in settings if create and flipped_name(one.name) not in present]
        matrix = linear_part(context, obj)
        self._offsets = read_offsets(obj, self.names, from_reference=self.names) @ matrix.T
        self._to_local = np.linalg.inv(matrix).T
        self._made = np.empty((0, *self._offsets.shape[1:]))

    def compute(self, symmetriser: Symmetriser) -> None:
        """Make them symmetric."""
        places = {name: place for place, name in enumerate(self.names)}
        made = [symmetriser.mirrored_offsets(self._offsets[places[one.name]]) for one in self._missing]
        other = partners(self.names)
        paired = np.flatnonzero(other >= 0)
        renumber = np.full(len(other), -1)
        renumber[paired] = np.arange(len(paired))
        self._offsets[paired] = symmetriser.offsets(self._offsets[paired], renumber[other[paired]])
        self._offsets = self._offsets @ self._to_local
        self._made = np.array(made).reshape(-1, *self._offsets.shape[1:]) @ self._to_local

    def write(self, obj: bpy.types.Object) -> str:
        """Write them, with nothing else of the keys changed."""
        blocks = cast("bpy.types.Key", keys_of(obj)).key_blocks
        before = [KeySettings.of(blocks[name], self.names) for name in self.names]
        new = [replace(one, name=flipped_name(one.name), vertex_group=_flipped_group(one)) for one in self._missing]
        add_keys(obj, [*before, *new], np.concatenate([self._offsets, self._made]))
        return counted(len(before) + len(new), "shape key")


class _Colors:
    """The color attributes that are not a match's, at vertices or at the corners of faces."""

    def __init__(self, obj: bpy.types.Object) -> None:
        mesh, ours = mesh_of(obj), written_names(obj)
        names = [attribute.name for attribute in mesh.color_attributes if attribute.name not in ours]
        self._corners = corner_vertices(mesh)
        self._values = {name: read_attribute(mesh, name).astype(np.float64) for name in names}
        self.notes = leave_out_broken(self._values, obj)
        self.names = list(self._values)
        self._domains = {name: attribute_layouts(mesh)[name].domain for name in self.names}

    def compute(self, symmetriser: Symmetriser) -> None:
        """Make them symmetric; what is mirrored to the corners of a vertex is the mean there."""
        n = len(symmetriser.own)
        for name, values in self._values.items():
            if self._domains[name] == "POINT":
                self._values[name] = symmetriser.values(values)
            else:
                counts = np.maximum(np.bincount(self._corners, minlength=n), 1)[:, None]
                sums = np.stack([np.bincount(self._corners, axis, n) for axis in values.T], axis=1)
                own = symmetriser.own[self._corners, None]
                mirrored = symmetriser.mirror.transfer(sums / counts)[self._corners]
                self._values[name] = own * values + (1 - own) * mirrored

    def write(self, obj: bpy.types.Object) -> str:
        """Write them."""
        mesh = mesh_of(obj)
        for name, values in self._values.items():
            write_attribute(mesh, attribute_layouts(mesh)[name], values)
        mesh.update()
        return counted(len(self.names), "color attribute")


def _flipped_group(settings: KeySettings) -> str:
    return flipped_name(settings.vertex_group) if settings.vertex_group else ""


def _hints(obj: bpy.types.Object) -> NDArray[np.float64]:
    """Tell left, positive, from right: by the weights of groups named for a side, or else by the X axis."""
    mesh = mesh_of(obj)
    ours = written_names(obj)
    names = [group.name for group in obj.vertex_groups]
    sides = np.array([0 if name in ours else side_of(name) for name in names], float)
    hints = read_weights(obj) @ sides if names else np.zeros(len(mesh.vertices))
    if hints.any():
        return hints
    return vertex_positions(mesh)[:, 0].astype(np.float64)
