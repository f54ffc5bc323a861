# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from engine.runtime.pipes import has_more, receive, send

ROOT = Path(__file__).parents[3]


@pytest.fixture
def pipe():
    """Both ends of a pipe: where it is read, and where it is written."""
    ends = os.pipe()
    yield ends
    for end in ends:
        with suppress(OSError):
            os.close(end)


@pytest.mark.parametrize("message", [b"", b"one", bytes(range(256)) * 16])
def test_messages_come_as_they_were_sent(pipe, message):
    send(pipe[1], message)
    send(pipe[1], b"the next")
    assert receive(pipe[0]) == message
    assert receive(pipe[0]) == b"the next"


def test_a_message_may_be_larger_than_the_pipe():
    message = os.urandom(5 << 20)
    script = "import os; from engine.runtime.pipes import receive, send; send(1, receive(0)[::-1])"
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", script], cwd=ROOT, bufsize=0, **streams) as process:
        send(process.stdin.fileno(), message)
        assert receive(process.stdout.fileno()) == message[::-1]


def test_where_nobody_writes_any_more_there_is_an_end(pipe):
    os.write(pipe[1], b"half of a")
    os.close(pipe[1])
    with pytest.raises(EOFError):
        receive(pipe[0])


def test_where_nobody_reads_any_more_nothing_can_be_sent(pipe):
    os.close(pipe[0])
    with pytest.raises(BrokenPipeError):
        send(pipe[1], b"message")


def test_a_look_says_whether_there_is_more(pipe):
    assert not has_more(pipe[0])
    assert not has_more(pipe[0], 0.05)
    send(pipe[1], b"message")
    assert has_more(pipe[0])
    receive(pipe[0])
    assert not has_more(pipe[0])
    os.close(pipe[1])
    assert has_more(pipe[0])
