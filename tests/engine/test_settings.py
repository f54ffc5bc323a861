# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import fields

import pytest

from engine import MatchSettings, SettingsError


def test_defaults_are_valid_and_every_setting_is_described():
    MatchSettings()
    for setting in fields(MatchSettings):
        assert setting.metadata["minimum"] <= setting.default <= setting.metadata["maximum"]
        assert setting.metadata["label"]
        assert len(setting.metadata["description"]) > 20


@pytest.mark.parametrize("name", [setting.name for setting in fields(MatchSettings)])
def test_values_outside_the_range_are_refused_by_the_name_that_the_user_sees(name):
    setting = next(s for s in fields(MatchSettings) if s.name == name)
    for bad in (setting.metadata["minimum"] - 1, setting.metadata["maximum"] + 1, float("nan")):
        with pytest.raises(SettingsError, match=setting.metadata["label"]):
            MatchSettings(**{name: bad})


def test_fewer_candidates_than_coarse_points_are_refused():
    with pytest.raises(SettingsError, match="at least as many Coarse Candidates"):
        MatchSettings(coarse_points=12, coarse_candidates=11)
