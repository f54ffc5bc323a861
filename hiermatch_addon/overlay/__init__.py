# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay that is drawn over the viewport."""
