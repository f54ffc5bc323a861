# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfers between two rigs: pairs of bones, motion, and weights through the pairs."""
