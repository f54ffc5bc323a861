# SPDX-License-Identifier: GPL-3.0-or-later
import gc
import pickle

from engine.runtime.messages import SentObjects
from tests.shared_work import Kept


def announced(sent, order):
    """Numbers of what is forgotten, and of what is new, and how many messages there are in all."""
    messages = sent.messages(order)
    gone, new, _ = pickle.loads(messages[0])  # noqa: S301 - our own
    return gone, new, len(messages)


def test_what_was_sent_is_not_sent_again():
    sent, kept = SentObjects(), Kept(1)
    assert announced(sent, (kept, 0)) == ([], [1], 3)
    assert announced(sent, (kept, 1)) == ([], [], 2)
    assert kept in sent
    assert Kept(1) not in sent


def test_what_something_refers_to_is_sent_before_it():
    sent, inner, outer = SentObjects(), Kept(1), Kept(2)
    outer.inner = inner
    assert announced(sent, outer) == ([], [1, 2], 4)
    assert inner in sent
    assert announced(sent, inner) == ([], [], 2)


def test_what_nobody_has_any_more_is_forgotten():
    sent, kept = SentObjects(), Kept(1)
    sent.messages(kept)
    del kept
    gc.collect()
    assert announced(sent, None) == ([1], [], 2)
    assert announced(sent, None) == ([], [], 2)


def test_numbers_are_not_given_twice():
    sent = SentObjects()
    for number in 1, 2, 3:
        kept = Kept(number)
        assert announced(sent, kept)[1] == [number]
        del kept
        gc.collect()


def test_classes_and_what_is_not_marked_are_written():
    sent, kept = SentObjects(), Kept(1)
    kept.is_sent_once = False
    assert announced(sent, (Kept, kept)) == ([], [], 2)
