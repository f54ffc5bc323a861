# SPDX-License-Identifier: GPL-3.0-or-later
"""Non-rigid registration of one surface to another."""
