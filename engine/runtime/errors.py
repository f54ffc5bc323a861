# SPDX-License-Identifier: GPL-3.0-or-later
"""The errors that the engine raises on input it cannot use.

Every message says what is wrong and what to do about it, in words that an artist can act on: the add-on shows
them as they are.  Anything else that escapes the engine is a bug.
"""

from __future__ import annotations


class HierMatchError(ValueError):
    """Base of all errors that are about the input and not about the program."""


class MeshError(HierMatchError):
    """A mesh that cannot be used as a surface."""


class SettingsError(HierMatchError):
    """A setting outside of its meaning."""


class MatchError(HierMatchError):
    """Two valid meshes and valid settings that together allow no matching."""


class RigError(HierMatchError):
    """Bones or weights that do not describe a rig."""
