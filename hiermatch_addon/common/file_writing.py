# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are written whole or not at all."""

from __future__ import annotations

import errno
import os
from contextlib import contextmanager
from os.path import realpath
from pathlib import Path
from typing import TYPE_CHECKING, Final
from uuid import uuid4

from .errors import ObjectError

if TYPE_CHECKING:
    from collections.abc import Iterator

_BEHIND: Final = 1 << 20
"""Bytes that must fit behind what Blender wrote: more than the largest block of a file system, so that a disk that had
no room for the end of a file has none for these."""


def check_place(path: Path) -> None:
    """Make sure, before long work, that a file can be written, as far as can be told without writing.

    One that is there and is read-only is not to be replaced, though the folder would allow it.

    Raises
    ------
    ObjectError
        If not.
    """
    folder = next((parent for parent in path.absolute().parents if _exists(parent)), path.parent)
    if _exists(path) and path.is_dir():
        reason = errno.EISDIR
    elif not folder.is_dir():
        reason = errno.ENOTDIR
    elif not os.access(folder, os.W_OK) or (_exists(path) and not os.access(path, os.W_OK)):
        reason = errno.EACCES
    else:
        return
    raise ObjectError(f'"{path}" cannot be written: {os.strerror(reason)}. Choose another place.')


def check_whole(path: Path) -> None:
    """Make sure that a file that Blender has just written is whole: of a full disk most of its writers say nothing.

    Raises
    ------
    OSError
        If nothing can be written behind it, either.
    """
    size = path.stat().st_size
    with path.open("ab") as file:  # on a network it is the closing that fails
        file.write(os.urandom(_BEHIND))  # zeros would take no room where disks are compressed
    os.truncate(path, size)


def _exists(path: Path) -> bool:
    """Tell whether there is such a file or folder; unlike `Path.exists` also of a name that is too long."""
    return os.access(path, os.F_OK)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file, with its folders, such that nobody ever sees a part of it.

    Raises
    ------
    ObjectError
        If it cannot be written.
    """
    with beside(path) as temporary:
        temporary.write_bytes(content)


@contextmanager
def beside(path: Path) -> Iterator[Path]:
    """Lend a name beside a file, of the same suffix; what is written there takes the file's place at last.

    Of a symbolic link that is the file that it leads to.

    Raises
    ------
    ObjectError
        If it cannot be written.
    """
    check_place(path)
    place = Path(realpath(path))
    temporary = place.with_name(f".{uuid4().hex}{path.suffix}")  # without the stem, which may be as long as can be
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        try:
            yield temporary
            temporary.replace(place)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise ObjectError(f'"{path}" cannot be written: {error.strerror or error}. Choose another place.') from error
