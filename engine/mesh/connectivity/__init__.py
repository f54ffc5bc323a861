# SPDX-License-Identifier: GPL-3.0-or-later
"""Connectivity of a mesh: half-edges, neighbours, components, borders, orientation."""
