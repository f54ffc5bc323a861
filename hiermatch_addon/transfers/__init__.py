# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of things that are carried from one matched mesh to another."""
