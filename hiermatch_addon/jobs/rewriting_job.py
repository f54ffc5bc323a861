# SPDX-License-Identifier: GPL-3.0-or-later
"""Work on a match that two meshes carry, at the end of which it is written anew."""

from __future__ import annotations

import time
from abc import abstractmethod
from typing import TYPE_CHECKING

from ..scene.character import SideReference
from ..scene.pair import check_pair
from ..storage.answer_writing import write_answer
from ..storage.halves import find_again
from .stepped_job import SteppedJob

if TYPE_CHECKING:
    from ..storage.contents import Content
    from ..storage.halves import Half
    from ..storage.stored_match import StoredMatch


class RewritingJob(SteppedJob):
    """What jobs have in common that write a stored match anew.

    Between two calls of `advance` Blender may do anything, so the job holds no references to its objects but looks
    them up again, and ends with an error if they are not what they were.  Nothing is written before `finish`.

    Parameters
    ----------
    halves : tuple of Half
        The two sides of the match, its source first.
    stored : StoredMatch
        What is kept of it; `_all_steps` replaces it by what is to be kept, and prepares what is to be written.
    started : float
        When the reading of it began, by `time.perf_counter`.

    Attributes
    ----------
    progress : Progress
        How far the work is.
    names : tuple of str
        What source and target of the match are called now.
    prefix, key : str
        Which match it is.
    seconds : float
        Once finished, how long it took.
    """

    def __init__(self, halves: tuple[Half, Half], stored: StoredMatch, started: float) -> None:
        source, target = halves
        self._start = started
        self.names, self.prefix, self.key = (source.obj.name, target.obj.name), source.prefix, source.key
        self._references = (SideReference.of(source.obj), SideReference.of(target.obj))
        self._stored = stored
        self._prepared: tuple[Content, Content] | None = None
        self.seconds = 0.0
        super().__init__()

    def finish(self) -> StoredMatch:
        """Write the match on both objects in place of the one before, and return what is kept of it.

        Raises
        ------
        HierMatchError
            If the objects have changed, or the user's own vertex groups or attributes are in the way.
        """
        if self._prepared is None:
            raise RuntimeError("The work has not come to its end yet.")
        source, target = self._halves()
        check_pair(None, source.obj, target.obj)
        for half in (source, target):
            self._check_half(half)
        self.names = (source.obj.name, target.obj.name)
        write_answer((source.obj, target.obj), self._stored, self._prepared, self.prefix)
        self.seconds = time.perf_counter() - self._start
        return self._stored

    @abstractmethod
    def _check_half(self, half: Half) -> None:
        """Make sure that the mesh is still what was read, before it is written to."""

    def _check(self) -> None:
        self._halves()

    def _halves(self) -> tuple[Half, Half]:
        """Look the objects up again and make sure that they still carry the match."""
        return find_again(self._references, self.prefix, self.key)
