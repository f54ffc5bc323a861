# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors about objects of the scene, beside the engine's errors about shapes and settings."""

from __future__ import annotations

from ...engine import HierMatchError


class ObjectError(HierMatchError):
    """An object that cannot be matched or written to as it stands; the message says why and what to do."""


class SharedMeshError(ObjectError):
    """A mesh of several objects, all of which would change with the one that is written to."""


class DoubtfulMatchError(ObjectError):
    """A match that nothing should be carried across unless somebody wants it all the same."""


class NothingToCarryError(ObjectError):
    """A source that has nothing of a kind: no reason to worry where many kinds are carried at once."""
