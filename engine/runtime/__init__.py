# SPDX-License-Identifier: GPL-3.0-or-later
"""The runtime: errors, progress, worker processes, threads of the linear algebra library, arrays."""
