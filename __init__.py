# SPDX-License-Identifier: GPL-3.0-or-later
"""HierMatch: the correspondence of two non-rigid shapes, as a Blender extension.

Blender needs this file beside ``blender_manifest.toml``.  It imports nothing by itself, so that tools that only
look at it (test collectors, linters) need no Blender.
"""


def register() -> None:
    """Register the add-on with Blender."""
    from . import hiermatch_addon

    hiermatch_addon.register()


def unregister() -> None:
    """Remove the add-on from Blender."""
    from . import hiermatch_addon

    hiermatch_addon.unregister()
