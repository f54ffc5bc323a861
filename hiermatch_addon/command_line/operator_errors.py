# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of Blender's operators, as one line."""

from __future__ import annotations

import re


def said_by(error: Exception) -> str:
    """Return what an operator said when it failed.

    Parameters
    ----------
    error : Exception
        What calling it raised.

    Returns
    -------
    str
        Its words in one line with one full stop.  Of an operator in Python that broke down, what happened last, and
        not all that was called then.
    """
    text = str(error)
    if "Traceback (most recent call last)" in text:
        happened = re.findall(r"^(?!Location:)[\w.]+(?:: .*)?$", text, re.MULTILINE)
        text = "Blender's add-on for such files broke down" + (f" ({happened[-1]})" if happened else "")
    return " ".join(text.split()).removeprefix("Error: ").rstrip(".") + "."
