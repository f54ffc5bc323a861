# SPDX-License-Identifier: GPL-3.0-or-later
"""The two meshes that are matched."""

from __future__ import annotations

import pytest

from tests.addon.scenes import add_picked_pair


@pytest.fixture
def pair():
    return add_picked_pair()
