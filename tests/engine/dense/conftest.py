# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tests of dense maps have in common."""

import pytest

from engine.dense import dense_hypotheses, registered_hypotheses
from engine.runtime.parallel_map import here_steps


@pytest.fixture(autouse=True)
def here(request):
    """Where a function is replaced, do all in this process: another one would not know of that."""
    if "monkeypatch" in request.fixturenames:
        for module in (dense_hypotheses, registered_hypotheses):
            request.getfixturevalue("monkeypatch").setattr(module, "shared_steps", here_steps)
