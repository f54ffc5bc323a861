# SPDX-License-Identifier: GPL-3.0-or-later
"""What the owner of a mesh is told."""

from dataclasses import fields

from engine.repair.cleaning_notes import CleaningCounts, cleaning_notes


def test_nothing_is_said_of_a_clean_mesh():
    assert cleaning_notes("source", CleaningCounts()) == ()


def test_every_fault_has_one_sentence():
    for field in fields(CleaningCounts):
        for count in (1, 2000):
            (note,) = cleaning_notes("target", CleaningCounts(**{field.name: count}))
            assert "target" in note
            assert note[0].isupper()
            assert note.endswith(".")
            assert isinstance(field.default, bool) or f" {count:,} " in note


def test_one_and_many():
    assert cleaning_notes("source", CleaningCounts(crowded=3, loose=1)) == (
        "The source had 3 non-manifold edges: they were opened for matching.",
        "The source has 1 loose vertex: it follows its surroundings.",
    )
