# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that operators report."""

import pytest
from hiermatch.engine import HierMatchError
from hiermatch.hiermatch_addon.operators.reported_errors import reporting_errors


class Operator:
    """What is called as Blender calls an operator."""

    def __init__(self):
        self.said = []

    def report(self, kinds, text):
        self.said.append((kinds, text))

    @reporting_errors
    def execute(self, context):
        """Do what the context says."""
        if isinstance(context, Exception):
            raise context
        return {"FINISHED"}


def test_errors_of_ours_end_an_operator_with_a_sentence():
    operator = Operator()
    assert operator.execute("anything") == {"FINISHED"}
    assert operator.said == []
    assert operator.execute(HierMatchError("It is broken. Repair it.")) == {"CANCELLED"}
    assert operator.said == [({"ERROR"}, "It is broken. Repair it.")]


def test_other_errors_are_bugs_and_are_raised():
    with pytest.raises(KeyError):
        Operator().execute(KeyError("bug"))
    assert Operator.execute.__doc__ == "Do what the context says."
