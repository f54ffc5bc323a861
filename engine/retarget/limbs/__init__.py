# SPDX-License-Identifier: GPL-3.0-or-later
"""Limbs of rigs: where they end, which are mirror images, and in which order their bones belong together."""
