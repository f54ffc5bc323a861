# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tests of motion through the buttons need."""

import pytest

from tests.addon.characters import match_at_once


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    """Match without work."""
    match_at_once(monkeypatch)
