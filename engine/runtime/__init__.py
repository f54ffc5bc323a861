# SPDX-License-Identifier: GPL-3.0-or-later
"""How work is run: errors, progress, worker processes, threads of the linear algebra library."""
