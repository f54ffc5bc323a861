# SPDX-License-Identifier: GPL-3.0-or-later
"""What is computed once per surface: proxy meshes, samples, distances, operators."""
