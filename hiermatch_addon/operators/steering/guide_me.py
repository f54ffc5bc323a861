# SPDX-License-Identifier: GPL-3.0-or-later
"""Ask for the places that tell a body's parts apart, one after the other, and match again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import bpy

from ...common.access import view_layer_of
from ...common.errors import ObjectError
from ...common.phrases import counted
from ...common.translated_text import translated
from ...jobs.running import start_soon
from ...properties.panel_state import state_of
from ...properties.properties import OPTION_NAMES
from ...scene.pair import name_of
from ...storage.landmarks import find_landmarks, remove_landmark
from .landmark_clicks import LandmarkClicks, is_key

if TYPE_CHECKING:
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    from .landmark_picking import Hit

_PLACES: Final = ("Nose", "Left Hand", "Right Hand", "Left Foot", "Right Foot", "Tail")
"""What is asked for, in turn; left and right are the character's own, and hands are the forefeet of an animal."""


class Guide(LandmarkClicks):
    """Clicks that are asked for by name; to be inherited from before `bpy.types.Operator`."""

    _step = 0

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Begin with the first place."""
        self._step = 0
        return super().invoke(context, event)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[OperatorReturnItems]:
        """Leave a place out, or take a click; after the last place match."""
        if is_key(context, event, "S"):
            self._pending = None
            self._step += 1
            answer: set[OperatorReturnItems] = {"RUNNING_MODAL"}
            if self._step < len(_PLACES):
                self._show_status(context)
        else:
            answer = super()._handle(context, event)
        if answer == {"RUNNING_MODAL"} and self._step >= len(_PLACES):
            self.cancel(context)
            self._done(context)
            return {"FINISHED"}
        return answer

    def _asked(self) -> list[tuple[int, ...]]:
        return [(0,), (1,)] if self._pending is None else [(1,), (0,)]

    def _take(self, context: bpy.types.Context, hit: Hit | None) -> None:
        """Take the place on the source first and then on the target, and go on to the next one.

        Another click on the source corrects the one before.
        """
        waits = self._pending is not None
        if hit is None or not (waits or self._clicked(hit).side == 0):
            raise ObjectError(f'Click on "{self._names[int(waits)]}" first, or press S to leave this place out.')
        if waits and self._clicked(hit).side == 1:
            self._drop_former()
        super()._take(context, hit)
        self._step += waits and self._pending is None

    def _follow_undo(self) -> bool:
        """Ask again for the first place that Undo has taken back, or go on behind the last that Redo has brought."""
        made = len(self._made)
        changed = super()._follow_undo()
        if changed:
            back = len(self._made) < made
            names = [translated(place) for place in _PLACES]
            self._step = names.index(self._undone[0].name) if back else names.index(self._made[-1].name) + 1
            self._pending = None
        return changed

    def _drop_former(self) -> None:
        """Remove a landmark that was made for the same place before."""
        source, target = self._found()
        for landmark in find_landmarks(source, target):
            if landmark.name == translated(_PLACES[self._step]):
                remove_landmark(source, target, landmark.number)

    def _prompt(self) -> str:
        if self._step >= len(_PLACES):
            return "Done"
        place, count = _PLACES[self._step], len(_PLACES)
        wanted = self._names[0] if self._pending is None else self._other
        return f'{place} ({self._step + 1} of {count}): click on it on "{wanted}"    S: leave out'

    def _place_name(self) -> str:
        return translated(_PLACES[self._step])

    def _done(self, context: bpy.types.Context) -> None:
        """Match again, if there is something new to go by."""
        if not self._made:
            self.report({"INFO"}, translated("No landmark was added, so there is nothing new to match by"))
            return
        state = state_of(context)
        state.use_landmarks = True
        options = {name: getattr(state, name) for name in OPTION_NAMES}
        source, target = (name_of(view_layer_of(context), side) for side in self._found())
        start_soon(context, "hiermatch.match", **options, source=source, target=target)
        self.report({"INFO"}, translated(f"Matching again with {counted(len(self._made), 'landmark')}"))


class HIERMATCH_OT_guide_me(Guide, bpy.types.Operator):
    """Click on nose, hands, feet and tail of both meshes in turn, and match again."""

    bl_idname = "hiermatch.guide_me"
    bl_label = "Guide Me"
    bl_description = (
        "Click on nose, hands, feet and tail of both meshes as you are asked for them; S leaves one out. After the "
        "last one, or Enter, the two are matched again with these landmarks"
    )
    bl_options = {"REGISTER"}  # each pair is a step of its own to undo
