# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper: hierarchical matching of sampled shapes."""
