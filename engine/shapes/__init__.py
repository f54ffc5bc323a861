# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes: proxy meshes, samples, distances and operators, computed once per surface."""
