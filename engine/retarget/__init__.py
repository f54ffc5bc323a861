# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfer of rigs, weights, values, motion and clothes across a map."""
