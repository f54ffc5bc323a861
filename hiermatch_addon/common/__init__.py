# SPDX-License-Identifier: GPL-3.0-or-later
"""What every part of the add-on uses, and nothing of Blender's data."""
