# SPDX-License-Identifier: GPL-3.0-or-later
"""Many pairs by one command: manifest, workers and the ledger of what is done."""
