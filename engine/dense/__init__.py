# SPDX-License-Identifier: GPL-3.0-or-later
"""The map of every vertex, beyond the paper."""
