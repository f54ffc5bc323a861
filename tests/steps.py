# SPDX-License-Identifier: GPL-3.0-or-later
"""Computations in steps, as tests drive them, and as they stand in for others."""


def followed(steps):
    """What a computation yields on the way, and what it returns."""
    reports = []
    while True:
        try:
            reports.append(next(steps))
        except StopIteration as stop:
            return reports, stop.value


def returned(value):
    """Steps that take none."""
    return value
    yield
