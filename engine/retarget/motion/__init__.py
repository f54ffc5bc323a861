# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones of two rigs paired by the surface, and motion and weights carried across the pairs."""
