# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain settings made of options."""

from types import SimpleNamespace

import pytest
from hiermatch.hiermatch_addon.transfers.options.attributes import (
    AttributeOptions,
    AttributeSettings,
    attribute_settings,
)
from hiermatch.hiermatch_addon.transfers.options.my_rig import MyRigOptions, MyRigSettings, my_rig_settings
from hiermatch.hiermatch_addon.transfers.options.plain_settings import names_in
from hiermatch.hiermatch_addon.transfers.options.rig import RigOptions, RigSettings, rig_settings
from hiermatch.hiermatch_addon.transfers.options.shape_keys import ShapeKeyOptions, ShapeKeySettings, shape_key_settings
from hiermatch.hiermatch_addon.transfers.options.symmetrise import (
    SymmetriseOptions,
    SymmetriseSettings,
    symmetrise_settings,
)
from hiermatch.hiermatch_addon.transfers.options.uvs import UVOptions, UVSettings, uv_settings
from hiermatch.hiermatch_addon.transfers.options.wear import WearOptions, WearSettings, wear_settings
from hiermatch.hiermatch_addon.transfers.options.weights import WeightOptions, WeightSettings, weight_settings
from hiermatch.hiermatch_addon.transfers.options.wrap import WrapOptions, WrapSettings, wrap_settings

NOTHING = {"BoolProperty": False, "IntProperty": 0, "FloatProperty": 0.0, "StringProperty": ""}
"""What properties without a default hold."""

KINDS = [
    (AttributeOptions, attribute_settings, AttributeSettings()),
    (MyRigOptions, my_rig_settings, MyRigSettings("")),
    (RigOptions, rig_settings, RigSettings()),
    (ShapeKeyOptions, shape_key_settings, ShapeKeySettings()),
    (SymmetriseOptions, symmetrise_settings, SymmetriseSettings()),
    (UVOptions, uv_settings, UVSettings()),
    (WearOptions, lambda options: wear_settings(options, ()), WearSettings()),
    (WeightOptions, weight_settings, WeightSettings()),
    (WrapOptions, wrap_settings, WrapSettings()),
]


def untouched(kind):
    """Options as they are to begin with."""
    found = kind.__annotations__.items()
    return SimpleNamespace(
        **{name: one.keywords.get("default", NOTHING.get(one.function.__name__)) for name, one in found}
    )


@pytest.mark.parametrize(("kind", "settings", "expected"), KINDS, ids=lambda one: getattr(one, "__name__", ""))
def test_options_as_they_are_to_begin_with_make_the_settings_without_a_word(kind, settings, expected):
    assert settings(untouched(kind)) == expected


@pytest.mark.parametrize(("kind", "settings", "expected"), KINDS, ids=lambda one: getattr(one, "__name__", ""))
def test_every_option_that_is_switched_reaches_the_settings(kind, settings, expected):
    options = untouched(kind)
    for name, value in vars(options).items():
        if isinstance(value, bool):
            other = settings(SimpleNamespace(**{**vars(options), name: not value}))
            assert sum(vars(other)[each] != vars(expected)[each] for each in vars(expected)) == 1


def test_names_are_told_apart_by_commas():
    assert names_in(" Smile, Frown,,Smile ,") == ("Smile", "Frown")
    assert names_in("") == ()
