# SPDX-License-Identifier: GPL-3.0-or-later
"""The state of the panels, and the settings."""
