# SPDX-License-Identifier: GPL-3.0-or-later
"""Other poses of armatures and meshes: for a while, and for good."""
