# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that only overlap: what they share, and how that corresponds."""
