# SPDX-License-Identifier: GPL-3.0-or-later
"""The front door: matching two shapes, and the uses of it."""
