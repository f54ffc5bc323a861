# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of bodies made of several components."""
