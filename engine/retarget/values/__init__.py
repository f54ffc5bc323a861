# SPDX-License-Identifier: GPL-3.0-or-later
"""Carrying values at vertices, corners, edges and faces."""
