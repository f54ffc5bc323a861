# SPDX-License-Identifier: GPL-3.0-or-later
"""Coarse remeshing of dense meshes."""
