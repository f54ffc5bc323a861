# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""The scene's properties for retargeting: the options of all kinds, and the report of the last transfer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import bpy

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..scene.character import parts_of
from ..scene.pair import named_side
from .options.motion import MotionOptions
from .options.my_rig import MyRigOptions
from .options.retarget import RetargetOptions
from .options.symmetrise import SymmetriseOptions
from .options.wear import WearOptions
from .options.wrap import WrapOptions

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..jobs.transfer_job import Carried
    from ..scene.character import Side

__all__ = [
    "HIERMATCH_PG_report",
    "HIERMATCH_PG_retarget",
    "copy_named",
    "remember_transfer",
    "reported_target",
    "retarget_of",
]

_props: Any = bpy.props  # whose functions Blender's stubs declare to return nothing


class HIERMATCH_PG_report(bpy.types.PropertyGroup):
    """What became of the last transfer; it is there if `done` is not empty."""

    source: _props.StringProperty(name="Source", description="Name of the source object")
    target: _props.StringProperty(name="Target", description="Name of the target object; of several, of the last one")
    done: _props.StringProperty(name="Done", description="What was carried over to which object, one per line")
    notes: _props.StringProperty(
        name="Notes", description="What was left out, or should be known, and why: one sentence per line"
    )
    remarks: _props.StringProperty(
        name="Remarks",
        description="What was left out, or should be known, but is no reason to worry: one sentence per line",
    )
    verdict: _props.StringProperty(
        name="Verdict",
        description="How far the matches can be trusted, one sentence per line; empty if that is unknown",
    )
    doubtful: _props.BoolProperty(name="Doubtful", description="Whether one of the matches is not to be trusted")
    seconds: _props.FloatProperty(name="Seconds", description="How long it took")


class HIERMATCH_PG_retarget(
    RetargetOptions, MyRigOptions, WrapOptions, WearOptions, SymmetriseOptions, MotionOptions, bpy.types.PropertyGroup
):
    """The state of the retargeting panels on a scene."""

    refine: _props.BoolProperty(
        name="Refine with Rig",
        description="If the source has a rig, fit it into the target and make the map of the match better with it, "
        "once for each match. It takes some seconds, and weights, joints and shape keys gain much",
        default=True,
    )
    bone_pair: _props.IntProperty(name="Pair", description="The row of the table of bones that is active", min=0)
    report: _props.PointerProperty(
        name="Report", description="What became of the last transfer", type=HIERMATCH_PG_report
    )


def retarget_of(context: bpy.types.Context) -> HIERMATCH_PG_retarget:
    """Return the state of the retargeting panels on the scene."""
    return cast("Any", context.scene).hiermatch_retarget


def reported_target(context: bpy.types.Context) -> Side | None:
    """Return the target of the last transfer; None if nothing in the view layer has its name any more."""
    layer, name = view_layer_of(context), retarget_of(context).report.target
    try:
        target = named_side(layer, name) if name else None
    except ObjectError:
        return None
    return target if target is not None and all(part.name in layer.objects for part in parts_of(target)) else None


def copy_named(source: object, target: object, names: Iterable[str]) -> None:
    """Copy the options of these names."""
    for name in names:
        setattr(target, name, getattr(source, name))


def remember_transfer(
    context: bpy.types.Context, names: tuple[str, str], carried: list[Carried], left_out: str = ""
) -> None:
    """Fill the report of what was carried.

    Parameters
    ----------
    context : bpy.types.Context
        Where it was.
    names : (str, str)
        By what the source and the last target are found again, see `name_of`.
    carried : list of Carried
        What became of all targets.
    left_out : str
        Which selected meshes were no targets, as a sentence.
    """
    report: Any = retarget_of(context).report
    report.source, report.target = names
    done = []
    for one in carried:
        what = [part.done for part in one.reports if part.done]
        done.append(f'Carried to "{one.target}": {", ".join(what) if what else "nothing"}')
    report.done = "\n".join(done)
    verdicts = [one.verdict for one in carried if one.verdict is not None]
    report.verdict = "\n".join(verdict.said for verdict in verdicts)
    report.doubtful = any(verdict.doubtful for verdict in verdicts)
    parts = [part for one in carried for part in one.reports]
    report.notes = "\n".join(dict.fromkeys(note for part in parts for note in part.notes))
    remarks = [*([left_out] if left_out else []), *(remark for part in parts for remark in part.remarks)]
    report.remarks = "\n".join(dict.fromkeys(remarks))
    report.seconds = carried[-1].seconds if carried else 0.0
