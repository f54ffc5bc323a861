# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact coarse step of the paper: branch and bound with its bounds and incumbents."""
