# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="valid-type"
"""The scene's properties for retargeting: the options of all kinds, and the report of the last transfer."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING, Any, Final, cast

import bpy

from ..common.access import view_layer_of
from ..common.errors import ObjectError
from ..properties.panel_state import picked, state_of
from ..scene.character import is_of, parts_of
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

_SESSIONS: Final = 1 << 30
"""How many numbers of sessions there are."""

_SESSION: Final = secrets.randbelow(_SESSIONS)
"""A number of this session: in another one, Blender gives the same objects other numbers."""


class HIERMATCH_PG_report(bpy.types.PropertyGroup):
    """What became of a transfer; it is there if `done` is not empty.

    Source and target are known by their names and, as names change and others get them, by the numbers that Blender
    gives to objects for one session.
    """

    source: bpy.props.StringProperty(name="Source", description="Name of the source object")
    target: bpy.props.StringProperty(
        name="Target", description="Name of the target object; of several, of the last one"
    )
    done: bpy.props.StringProperty(name="Done", description="What was carried over to which object, one per line")
    notes: bpy.props.StringProperty(
        name="Notes", description="What was left out, or should be known, and why: one sentence per line"
    )
    remarks: bpy.props.StringProperty(
        name="Remarks",
        description="What was left out, or should be known, but is no reason to worry: one sentence per line",
    )
    verdict: bpy.props.StringProperty(
        name="Verdict",
        description="How far the matches can be trusted, one sentence per line; empty if that is unknown",
    )
    doubtful: bpy.props.BoolProperty(name="Doubtful", description="Whether one of the matches is not to be trusted")
    seconds: bpy.props.FloatProperty(name="Seconds", description="How long it took")
    source_uid: bpy.props.IntProperty(
        name="Source Number", description="By what number Blender knows the first object of the source"
    )
    target_uid: bpy.props.IntProperty(
        name="Target Number", description="By what number Blender knows the first object of the target"
    )
    session: bpy.props.IntProperty(
        name="Session", description="In which session these numbers hold; in others, names are gone by"
    )


class HIERMATCH_PG_retarget(
    RetargetOptions, MyRigOptions, WrapOptions, WearOptions, SymmetriseOptions, MotionOptions, bpy.types.PropertyGroup
):
    """The state of the retargeting panels on a scene."""

    refine: bpy.props.BoolProperty(
        name="Refine with Rig",
        description="If the source has a rig, fit it into the target and make the map of the match better with it, "
        "once for each match. It takes some seconds, and weights, joints and shape keys gain much",
        default=True,
    )
    bone_pair: bpy.props.IntProperty(name="Pair", description="The row of the table of bones that is active", min=0)
    report: bpy.props.PointerProperty(
        name="Report", description="What became of the last transfer", type=HIERMATCH_PG_report
    )
    reports: bpy.props.CollectionProperty(
        name="Reports",
        description="What became of the last transfer of each panel, by the panel's identifier",
        type=HIERMATCH_PG_report,
    )


def retarget_of(context: bpy.types.Context) -> HIERMATCH_PG_retarget:
    """Return the state of the retargeting panels on the scene."""
    return cast("Any", context.scene).hiermatch_retarget


def reported_target(context: bpy.types.Context) -> Side | None:
    """Return the target of the last transfer; None if nothing in the view layer has its name any more."""
    report = retarget_of(context).report
    return _named(context, report.target) if _first_object(context, report, "target") is not None else None


def shown_report(context: bpy.types.Context, panel: str) -> HIERMATCH_PG_report | None:
    """Return what a panel tells of the last transfer that was started from it.

    It is about the two that were its source and its target: it is shown as long as the target is there and nothing else
    is picked in place of one of them.
    """
    report: Any = cast("Any", retarget_of(context)).reports.get(panel)
    if report is None or not report.done or _first_object(context, report, "target") is None:
        return None
    for role, chosen in zip(("source", "target"), picked(state_of(context)), strict=True):
        obj = _first_object(context, report, role)
        if chosen is not None and (obj is None or not is_of(obj, chosen)):
            return None
    return cast("HIERMATCH_PG_report", report)


def shown_target(context: bpy.types.Context, report: HIERMATCH_PG_report) -> Side | None:
    """Return the target of a report by its name; None if it was renamed."""
    target, first = _named(context, report.target), _first_object(context, report, "target")
    return target if target is not None and first in parts_of(target) else None


def _named(context: bpy.types.Context, name: str) -> Side | None:
    """Return what has a name, if all of it is in the view layer."""
    layer = view_layer_of(context)
    try:
        side = named_side(layer, name) if name else None
    except ObjectError:
        return None
    return side if side is not None and all(part.name in layer.objects for part in parts_of(side)) else None


def _first_object(context: bpy.types.Context, report: HIERMATCH_PG_report, role: str) -> bpy.types.Object | None:
    """Return the first object of the source or the target of a report, if it is still in the view layer."""
    if report.session == _session(context):
        uid = getattr(report, f"{role}_uid")
        objects: Any = view_layer_of(context).objects  # None among them: it is being removed
        return next((obj for obj in objects if obj is not None and obj.session_uid == uid), None)
    side = _named(context, getattr(report, role))
    return None if side is None else parts_of(side)[0]


def _session(context: bpy.types.Context) -> int:
    """Return a number of this session since the file was opened, by which the scene got a new number as well."""
    return (_SESSION + cast("bpy.types.Scene", context.scene).session_uid) % _SESSIONS


def copy_named(source: object, target: object, names: Iterable[str]) -> None:
    """Copy the options of these names."""
    for name in names:
        setattr(target, name, getattr(source, name))


def remember_transfer(
    context: bpy.types.Context, panel: str, names: tuple[str, str], carried: list[Carried], left_out: str = ""
) -> None:
    """Fill the report of what was carried, and that of a panel.

    Parameters
    ----------
    context : bpy.types.Context
        Where it was.
    panel : str
        Identifier of the panel that it was started from.
    names : (str, str)
        By what the source and the last target are found again, see `name_of`.
    carried : list of Carried
        What became of all targets.
    left_out : str
        Which selected meshes were no targets, as a sentence.
    """
    options: Any = retarget_of(context)
    if panel not in options.reports:
        options.reports.add().name = panel
    for report in (options.report, options.reports[panel]):
        report.source, report.target = names
        sides = [_named(context, name) for name in names]
        report.source_uid, report.target_uid = (0 if side is None else parts_of(side)[0].session_uid for side in sides)
        report.session = _session(context)
        _tell(report, carried, left_out)


def _tell(report: Any, carried: list[Carried], left_out: str) -> None:  # noqa: ANN401 - HIERMATCH_PG_report
    """Write into a report what was carried."""
    report.done = "\n".join(
        f'Carried to "{one.target}": {one.done}' if one.carries else f'Found for "{one.target}": {one.done}'
        for one in carried
    )
    verdicts = [one.verdict for one in carried if one.verdict is not None]
    report.verdict = "\n".join(verdict.said for verdict in verdicts)
    report.doubtful = any(verdict.doubtful for verdict in verdicts)
    parts = [part for one in carried for part in one.reports]
    report.notes = "\n".join(dict.fromkeys(note for part in parts for note in part.notes))
    remarks = [*([left_out] if left_out else []), *(remark for part in parts for remark in part.remarks)]
    report.remarks = "\n".join(dict.fromkeys(remarks))
    report.seconds = carried[-1].seconds if carried else 0.0
