# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes and accessories as objects: which there are, their form, fitted copies."""
