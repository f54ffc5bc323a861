# SPDX-License-Identifier: GPL-3.0-or-later
"""Other processes, as tests see them."""

import os
from pathlib import Path


def is_gone(pid):
    """Whether a process of ours has ended, be it that nobody has asked yet how."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    status = Path(f"/proc/{pid}/stat")
    return status.exists() and status.read_text().rpartition(")")[2].split()[0] == "Z"
