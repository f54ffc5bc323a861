# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes of the source on the target: reading, fitting, moving and writing them."""
