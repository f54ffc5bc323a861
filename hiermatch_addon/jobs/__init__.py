# SPDX-License-Identifier: GPL-3.0-or-later
"""Long work in short steps, with progress and cancelling."""
