# SPDX-License-Identifier: GPL-3.0-or-later
"""Armatures in motion: their bodies, actions, poses and strips."""
