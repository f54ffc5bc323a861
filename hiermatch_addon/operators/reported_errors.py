# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that an operator reports as sentences, in the place of a traceback."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any

from ...engine import HierMatchError
from ..common.translated_text import translated

if TYPE_CHECKING:
    from collections.abc import Callable

    import bpy
    from bpy.stub_internal.rna_enums import OperatorReturnItems

    _Execute = Callable[[Any, bpy.types.Context], set[OperatorReturnItems]]


def reporting_errors(execute: _Execute) -> _Execute:
    """Let the `execute` of an operator end with a report where it raises one of our errors, whose message says why."""

    @wraps(execute)
    def reported(self: bpy.types.Operator, context: bpy.types.Context) -> set[OperatorReturnItems]:
        try:
            return execute(self, context)
        except HierMatchError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}

    return reported
