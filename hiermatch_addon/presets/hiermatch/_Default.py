# SPDX-License-Identifier: GPL-3.0-or-later
# ruff: noqa: INP001 - a script that Blender runs, and no module
"""All as it comes: what a preset does not set is at its default."""
