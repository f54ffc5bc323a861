# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough maps of whole surfaces, from matchings of a few points and from rigid motions."""
