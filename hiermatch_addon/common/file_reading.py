# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that anybody may have made: read such that nothing gets further that Blender could not keep."""

from __future__ import annotations

import json
import zipfile
import zlib
from typing import TYPE_CHECKING, Any, Final

from .errors import ObjectError

if TYPE_CHECKING:
    from pathlib import Path

BAD_FILE: Final = (
    ValueError,
    OverflowError,
    KeyError,
    TypeError,
    AttributeError,
    EOFError,
    IndexError,
    MemoryError,
    NotImplementedError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What Python's and NumPy's readers raise of files that are damaged or something else."""


def read_text(path: Path) -> str:
    """Read a text file, with or without the mark that editors on Windows begin it with.

    Raises
    ------
    ObjectError
        If it cannot be read, or is none.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ObjectError(f'"{path}" cannot be read: {error.strerror}. Choose another file.') from error
    except UnicodeDecodeError as error:
        raise ObjectError(f'"{path}" is no text. Choose a file that HierMatch has written.') from error


def parsed_json(text: str) -> Any:  # noqa: ANN401 - whatever it holds
    """Return what a JSON text holds, all texts of which Blender can keep.

    Raises
    ------
    ValueError
        If it is no JSON, or holds texts that are none.
    """
    try:
        plain = json.loads(text)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error
    if "\\u0000" in text:
        raise ValueError("a text in it goes on behind its end")
    if "\\ud" in text.lower():
        json.dumps(plain, ensure_ascii=False).encode()  # which fails for half a character
    return plain
