# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that carry rigs, weights, keys, UVs and attributes."""
