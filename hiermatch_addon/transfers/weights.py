# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights of vertex groups, carried from one matched mesh to another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_array

from ...engine import Columns, carry_weights_steps, put_in, row_sums, with_rows
from ..common.access import mesh_of
from ..common.errors import ObjectError
from ..common.phrases import counted, listed
from ..common.side_names import flipped_name
from ..jobs.transfer import Transfer, TransferReport
from ..scene.attribute_io import AttributeLayout, is_free
from ..scene.character import parts_of, vertex_ranges
from ..scene.deform_layer import check_weights_writable, read_group
from ..storage import writing
from ..storage.contents import Content
from ..storage.written_names import written_names
from .weight_groups import chosen_groups, deforming_bones, group_columns, group_names, locked_groups, write_groups

if TYPE_CHECKING:
    import bpy
    from numpy.typing import NDArray

    from ...engine import Steps
    from ..jobs.transfer import Passage
    from ..scene.character import Side
    from .options.weights import WeightSettings

_SUFFIX = "Rejected"

_TORN, _WHOLE = (0.7, 0.02, 0.02, 1.0), (1.0, 1.0, 1.0, 1.0)
"""Linear colors of vertices whose own weights were rejected, and of others."""

_RIGID = 0.5
"""From which weight on in the group of rigid pieces a vertex says that its piece is rigid."""

_WHOLE_SUM = 1e-3
"""How far from one the weights of a vertex may sum to that are shares of a whole."""


@dataclass(frozen=True, eq=False)
class _Task:
    """What was read: the names of g groups, which of them are to be carried, and their weights on both objects."""

    names: list[str]
    chosen: NDArray[np.bool_]
    columns: Columns
    telling: NDArray[np.bool_]
    source_weights: csr_array
    before: csr_array


class WeightTransfer(Transfer):
    """Carries weights; see `Transfer`.

    Parameters
    ----------
    settings : WeightSettings
        Which groups, and how.
    """

    label = "Weights"

    def __init__(self, settings: WeightSettings) -> None:
        self._settings = settings
        self._task: _Task
        self._result: csr_array = csr_array((0, 0))
        self._torn: NDArray[np.bool_] = np.zeros(0, bool)
        self._pieces: NDArray[np.int8] | None = None
        self._notes: list[str] = []

    def read(self, _context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read the weights of both, and make sure that the target's can be written."""
        chosen = chosen_groups(source, self._settings.groups)
        for part in parts_of(target):
            check_weights_writable(part)
        written = {name for part in parts_of(target) for name in written_names(part)}
        taken = [name for name in chosen if name in written]
        if taken:
            chosen = [name for name in chosen if name not in taken]
            self._notes.append(
                f'{listed(taken)} of "{source.name}" was left out: on "{target.name}" a match wrote what has that name.'
            )
        locked = locked_groups(target)
        stay = [name for name in chosen if name in locked]
        if stay:
            self._notes.append(f'Locked vertex groups of "{target.name}" were left alone: {listed(stay)}.')
        if len(stay) == len(chosen):
            raise ObjectError(
                f'All vertex groups to carry are locked on "{target.name}". Unlock some of them, or carry others.'
            )
        if self._settings.mark:
            self._check_mark(target)
        self._task = self._make_task(source, target, chosen, locked)
        self._pieces = np.concatenate([_said_of_pieces(part, self._settings.rigid_group) for part in parts_of(target)])

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute the weights of the target."""
        task, settings = self._task, self._settings
        carried = yield from carry_weights_steps(
            task.source_weights,
            passage.pair.source,
            passage.pair.target,
            passage.pair.target_to_source,
            telling=task.telling if task.telling.any() else None,
            fill=settings.fill,
            fill_alone=settings.alone == "FILL",
            rigid=settings.rigid,
            pieces=self._pieces,
        )
        self._torn = carried.torn
        self._result = put_in(
            task.before,
            carried.weights,
            task.columns,
            factor=settings.mix,
            add=settings.mode == "ADD",
            threshold=settings.clean,
            limit=settings.limit,
            normalise=settings.normalise,
        )
        alone = np.flatnonzero(~passage.pair.target_to_source.has_partner)
        if settings.alone == "LEAVE" and len(alone):
            self._result = with_rows(self._result, alone, csr_array(task.before[alone]))

    def write(self, _context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write the groups."""
        if self._settings.mark:
            self._check_mark(target)
        columns, names = self._task.columns, self._task.names
        written = ~columns.locked & (columns.new | (columns.shared & columns.yielding & self._settings.normalise))
        numbers = np.flatnonzero(written)
        result = self._result.tocsr()[:, numbers]
        wanted = [names[number] for number in numbers]
        write_groups(target, wanted, result, every=len(parts_of(target)) == 1)
        for part in parts_of(target):
            self._add_other_sides(source, part)
        if self._settings.mark:
            self._write_mark(target)
        had, has = ((abs(weights).sum(axis=0) > 0) for weights in (self._task.before, self._result))
        if emptied := [names[number] for number in np.flatnonzero(~self._task.chosen & columns.new & had & ~has)]:
            self._notes.append(
                f'Vertex groups of "{target.name}" for bones that move nothing of "{source.name}" were emptied: '
                f"{listed(emptied)}."
            )
        filled = int(self._torn.sum())
        if filled:
            parts = zip(parts_of(target), vertex_ranges(target), strict=True)
            torn = listed([part.name for part, own in parts if self._torn[own].any()])
            self._notes.append(
                f"Weights of {counted(filled, 'vertex')} of {torn} were taken from their neighbors: the map leads "
                f'them astray, far from these on "{source.name}".'
            )
        return TransferReport(
            counted(int((self._task.chosen & ~columns.locked).sum()), "vertex group"), tuple(self._notes)
        )

    def _make_task(self, source: Side, target: Side, chosen: list[str], locked: set[str]) -> _Task:
        """Find out what is what among all groups that matter.

        Beside those to carry these are other groups of the target's bones: locked ones, which take their share of the
        whole, and if only some groups are carried, all others, which give way.  Else those of the source's bones are
        carried as well, which have no weight there.
        """
        users = group_names(source)
        bones = deforming_bones(source, target)
        if not bones and _is_whole(group_columns(source, users, np.ones(len(users), bool))):
            # Without an armature to ask: groups that share out each vertex are those of bones.
            bones = set(users)
        some, its_bones = self._settings.groups in ("SELECTED", "ACTIVE"), deforming_bones(source)
        besides = [
            name
            for name in dict.fromkeys(group.name for part in parts_of(target) for group in part.vertex_groups)
            if name in bones and name not in chosen and (some or name in locked or name in its_bones)
        ]
        names = [*chosen, *besides]
        new = np.array([name in chosen or not (some or name in locked) for name in names])
        shared = np.array([name in bones for name in names])
        columns = Columns(np.array([name in locked for name in names]), new, shared, yielding=some)
        picked = np.arange(len(names)) < len(chosen)
        return _Task(
            names, picked, columns, shared & picked, group_columns(source, names, new), group_columns(target, names)
        )

    def _add_other_sides(self, source: Side, target: bpy.types.Object) -> None:
        """Add the empty groups of the other side that the source has, for whoever mirrors the target."""
        present = {group.name for part in parts_of(source) for group in part.vertex_groups}
        for name in self._task.names:
            other = flipped_name(name)
            if name in target.vertex_groups and other in present and other not in target.vertex_groups:
                active = target.vertex_groups.active_index
                target.vertex_groups.new(name=other)
                target.vertex_groups.active_index = active or 0

    @property
    def _mark_name(self) -> str:
        return f"{self._settings.prefix} {_SUFFIX}"

    def _check_mark(self, target: Side) -> None:
        """Make sure that the color attribute can be written.

        Raises
        ------
        ObjectError
            If something else has its name.
        """
        for part in parts_of(target):
            if not is_free(part, AttributeLayout(self._mark_name, "FLOAT_COLOR", "POINT")):
                raise ObjectError(
                    f'"{part.name}" already has something else called "{self._mark_name}". Rename it, or turn Mark '
                    "Rejected off."
                )

    def _write_mark(self, target: Side) -> None:
        """Write and show the color attribute."""
        colors = np.where(self._torn[:, None], _TORN, _WHOLE).astype(np.float32)
        writing.extend(target, Content(colors={self._mark_name: colors}), self._settings.prefix)
        for part in parts_of(target):
            attributes = mesh_of(part).attributes
            attributes.active_color_name = self._mark_name
            attributes.default_color_name = attributes.default_color_name or self._mark_name


def _said_of_pieces(obj: bpy.types.Object, name: str) -> NDArray[np.int8]:
    """Read what a vertex group says of loose pieces, (n,): 1 that they are rigid, -1 that they are not, 0 nothing."""
    weights = read_group(obj, name)
    return np.where(np.isnan(weights), 0, np.where(weights >= _RIGID, 1, -1)).astype(np.int8)


def _is_whole(weights: csr_array) -> bool:
    """Tell whether the weights of each vertex that has any are shares of a whole."""
    sums = row_sums(weights)
    return bool((sums > 0).any() and (abs(sums[sums > 0] - 1) < _WHOLE_SUM).all())
