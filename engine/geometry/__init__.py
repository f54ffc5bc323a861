# SPDX-License-Identifier: GPL-3.0-or-later
"""Metrics and operators on surfaces, and the linear algebra under them."""
