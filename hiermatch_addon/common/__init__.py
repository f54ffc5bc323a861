# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools of all parts of the add-on, without Blender's data."""
