# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes, points on them, and maps between them."""
