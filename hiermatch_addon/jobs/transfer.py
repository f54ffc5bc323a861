# SPDX-License-Identifier: GPL-3.0-or-later
"""The protocol of transfers between matched meshes: each kind reads, computes and writes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import bpy

    from ...engine import FittedRig, Steps
    from ..scene.character import Side
    from ..storage.vertex_maps import MapPair


@dataclass(frozen=True, eq=False)
class Passage:
    """The way from a source to a target.

    Attributes
    ----------
    pair : MapPair
        The two meshes without their modifiers, in world space, and the maps between all their vertices; refined with
        the rig if there is one.
    rig : FittedRig or None
        The source's rig, fitted into the target: in world space as well.  None if the source has none, or nobody
        asked for it.
    bone_names : tuple of str
        Names of the rig's bones, in its order.
    """

    pair: MapPair
    rig: FittedRig | None = None
    bone_names: tuple[str, ...] = ()


@dataclass(frozen=True)
class TransferReport:
    """What became of a transfer.

    Attributes
    ----------
    done : str
        What was written, such as "53 vertex groups"; empty if nothing was.
    notes : tuple of str
        What was left out, or is to be known, and why: one sentence each.
    remarks : tuple of str
        The same, where it is no reason to worry.
    carries : bool
        Whether something was carried over, and not only found out.
    """

    done: str
    notes: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    carries: bool = True


class Transfer(Protocol):
    """One kind of thing that is carried from one source to one target, each an object or a character of several.

    Attributes
    ----------
    label : str
        What is carried, for the progress bar: "Weights".
    uses_rig : bool
        Whether it goes better with the source's rig fitted into the target first.
    mirrors : bool
        Whether it can be carried across a match that exchanges left and right.
    """

    label: str
    uses_rig: bool = True
    mirrors: bool = True

    def read(self, context: bpy.types.Context, source: Side, target: Side) -> None:
        """Read everything from all objects of both sides and make sure that it can be written.

        Raises
        ------
        HierMatchError
            If it cannot be carried over, in a sentence that says why and what to do.
        """

    def steps(self, passage: Passage) -> Steps[None]:
        """Compute what is to be written, without touching Blender's data."""

    def check(self) -> None:
        """Make sure, before anything is written, that what was read beside the two sides is still as it was.

        Raises
        ------
        HierMatchError
            If it was deleted or edited since.
        """
        return

    def write(self, context: bpy.types.Context, source: Side, target: Side) -> TransferReport:
        """Write it."""
