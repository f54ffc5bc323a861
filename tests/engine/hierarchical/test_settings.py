# SPDX-License-Identifier: GPL-3.0-or-later
from dataclasses import fields

import numpy as np
import pytest

from engine import MatchSettings, SettingsError
from engine.hierarchical.settings import SETUPS

FIELDS = {setting.name: setting for setting in fields(MatchSettings)}
NUMBERS = [name for name, setting in FIELDS.items() if "minimum" in setting.metadata]
CHOICES = [name for name, setting in FIELDS.items() if "choices" in setting.metadata]


def test_defaults_are_valid_and_every_setting_is_described():
    MatchSettings()
    for setting in FIELDS.values():
        assert setting.metadata["label"]
        assert len(setting.metadata["description"]) > 20
    for name in NUMBERS:
        assert FIELDS[name].metadata["minimum"] <= FIELDS[name].default <= FIELDS[name].metadata["maximum"]
    for name in CHOICES:
        assert all(label and text for label, text in FIELDS[name].metadata["choices"].values())


@pytest.mark.parametrize("name", NUMBERS)
def test_values_outside_the_range_are_refused_by_the_name_that_the_user_sees(name):
    about = FIELDS[name].metadata
    for bad in (about["minimum"] - 1, about["maximum"] + 1, float("nan")):
        with pytest.raises(SettingsError, match=about["label"]):
            MatchSettings(**{name: bad})


@pytest.mark.parametrize("name", CHOICES)
def test_unknown_words_are_refused_with_the_known_ones(name):
    about = FIELDS[name].metadata
    for word in about["choices"]:
        assert getattr(MatchSettings(**{name: word}), name) == word
    with pytest.raises(SettingsError, match=f"{about['label']} is 'nonsense'.*{next(iter(about['choices']))}"):
        MatchSettings(**{name: "nonsense"})


def test_the_four_setups_of_the_paper_are_valid_and_different():
    made = {MatchSettings(**choices) for _, choices in SETUPS.values()}
    assert len(made) == 4


def test_fewer_candidates_than_coarse_points_are_refused():
    with pytest.raises(SettingsError, match="at least as many Coarse Candidates"):
        MatchSettings(coarse_points=12, coarse_candidates=11)


def test_a_bijective_coarse_match_has_as_many_candidates_as_points_whatever_is_set():
    assert MatchSettings(constraint="bijective", coarse_points=12, coarse_candidates=11).coarse_candidates == 11


def test_coarse_points_and_candidates_are_not_compared_where_there_is_no_coarse_step():
    assert MatchSettings(solver="flat", coarse_points=12, coarse_candidates=11).coarse_candidates == 11
    with pytest.raises(SettingsError, match="at least as many Coarse Candidates"):
        MatchSettings(solver="gmds", coarse_points=12, coarse_candidates=11)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"points": 64.5}, "Points is 64.5, but must be a whole number"),
        ({"points": "64"}, "Points is '64', but must be a whole number"),
        ({"samples": True}, "Samples is True, but must be a whole number"),
        ({"linear_weight": "1"}, "Descriptor Weight is '1', but must be a number"),
        ({"dense": "yes"}, "Dense Map is 'yes', but must be True or False"),
        ({"metric": ["geodesic"]}, "Metric is .*, but must be one of"),
    ],
)
def test_values_of_another_type_are_refused(values, said):
    with pytest.raises(SettingsError, match=said):
        MatchSettings(**values)


def test_numbers_of_numpy_are_numbers():
    made = MatchSettings(points=np.int64(20), linear_weight=np.float32(0.5), quadratic_weight=2, dense=np.isnan(1.0))
    assert (made.points, made.linear_weight, made.dense) == (20, 0.5, False)
