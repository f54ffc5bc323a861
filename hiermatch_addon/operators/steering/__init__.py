# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that steer a match: landmarks and pairs."""
