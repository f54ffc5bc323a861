# SPDX-License-Identifier: GPL-3.0-or-later
"""What hangs together in a mesh: half-edges, neighbours, components, borders, orientation."""
