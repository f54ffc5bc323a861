# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators to look at what a retarget has made."""
