# SPDX-License-Identifier: GPL-3.0-or-later
"""Manifold surfaces from artists' meshes."""
