# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods that the paper compares with: flat matching, GMDS, and stress descent, which also settles points."""
