# SPDX-License-Identifier: GPL-3.0-or-later
"""The match as the objects keep it."""
