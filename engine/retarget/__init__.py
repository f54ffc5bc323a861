# SPDX-License-Identifier: GPL-3.0-or-later
"""What is carried across a map."""
