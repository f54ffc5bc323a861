# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours that show a match."""
