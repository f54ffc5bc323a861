# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's four setups as named choices of the settings."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Final

from ...engine import SETUPS, MatchSettings
from .properties import set_settings, setting_of, to_identifier

if TYPE_CHECKING:
    from .properties import MatchOptions


def _description(setup: str) -> str:
    """Say what a setup sets."""
    abouts = {setting.name: setting.metadata for setting in fields(MatchSettings)}
    set_to = [
        f"{abouts[name]['label']} to {abouts[name]['choices'][word][0]}" for name, word in SETUPS[setup][1].items()
    ]
    return f"Set {', '.join(set_to)}, as in figure 2 ({setup}) of the paper"


SETUP_ITEMS: Final = tuple((to_identifier(setup), name, _description(setup)) for setup, (name, _) in SETUPS.items())
"""Identifier, name and description of each setup, as Blender wants them."""


def current_setup(options: MatchOptions) -> str | None:
    """Return the name of the setup that the settings make, if they make one."""
    for name, values in SETUPS.values():
        if all(setting_of(options, setting) == value for setting, value in values.items()):
            return name
    return None


def use_setup(options: MatchOptions, identifier: str) -> str:
    """Set the settings that make a setup, leave all others alone, and return the setup's name."""
    name, values = next(setup for key, setup in SETUPS.items() if to_identifier(key) == identifier)
    set_settings(options, values)
    return name
