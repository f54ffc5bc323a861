# SPDX-License-Identifier: GPL-3.0-or-later
"""Match characters of games that are made of pieces, in different poses.

    apt-get download cube2-data redeclipse-data
    for each of them: dpkg-deb -x PACKAGE FOLDER
    python -m tests.benchmarks.game_characters --games FOLDER/usr/share/games [--pairs 12] [--seed 1]

A squirrel with its tail and claws, a creature with its limbs, and a soldier, whose arms, legs, head and trunk are all
pieces of their own.  Poses are frames of their animations; the vertices of the target are renumbered.  A row says which
poses, the mean distance of all vertices from their true place, over the square root of the area, times 100; the same
for those of the largest piece alone, which is the one that is matched; the share of the others that are more than 5
away; the confidence and the seconds.  Then follow the means of each character.
"""

import argparse
import time
from pathlib import Path

import numpy as np

from engine import MatchSettings, TriangleMesh, match
from engine.repair.cleaning import clean
from tests.benchmarks.iqm_models import read_character, read_frames

CHARACTERS = {
    "squirrel": ("cube2/packages/models/frankie/Frankie.iqm", "Frankie_*.iqm"),
    "creature": ("cube2/packages/models/snoutx10k/snoutx10k.iqm", "*.md5anim.iqm"),
    "soldier": ("redeclipse/data/actors/player/male/RE_Player_male.iqm", "../*.iqm"),
}
AWAY = 5.0


def poses(games, name):
    """Read a character and its poses: the first and the middle frame of each animation, by name."""
    path, pattern = CHARACTERS[name]
    character = read_character(games / path)
    found = {}
    for animation in sorted((games / path).parent.glob(pattern)):
        frames = read_frames(animation)
        if frames.shape[1] == len(character.bones):
            found |= {f"{animation.stem}:{number}": frames[number] for number in {0, len(frames) // 2} if len(frames)}
    return character, found


def compared(character, first, second, rng):
    """Match two poses (b, 4, 4): the row of the table."""
    here, there = character.posed(first), character.posed(second)
    order = rng.permutation(len(there))
    source = TriangleMesh(here, character.triangles)
    target = TriangleMesh(there[order], np.argsort(order)[character.triangles])
    start = time.perf_counter()
    result = match(source, target, MatchSettings(dense=True))
    seconds = time.perf_counter() - start
    errors = 100 * np.linalg.norm(result.source_to_target.points.positions - there, axis=1) / np.sqrt(source.area)
    main = clean(source).vertex_parts == 0
    away = 100 * (errors[~main] > AWAY).mean()
    return errors.mean(), errors[main].mean(), away, result.quality.confidence, seconds


def main():
    """Match the pairs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", type=Path, required=True, help="folder of the packages' games")
    parser.add_argument("--pairs", type=int, default=12, help="pairs of each character (default: 12)")
    parser.add_argument("--seed", type=int, default=1)
    settings = parser.parse_args()
    print(f"{'':60}  mean   main   away  conf. seconds")
    means = []
    for name in CHARACTERS:
        character, frames = poses(settings.games, name)
        rng = np.random.default_rng(settings.seed)
        rows = []
        for _ in range(settings.pairs):
            first, second = (list(frames)[number] for number in rng.choice(len(frames), 2, replace=False))
            rows.append(compared(character, frames[first], frames[second], rng))
            pair = f"{name} {first} -> {second}"
            print(f"{pair:60} {_line(rows[-1])}", flush=True)
        means.append((name, np.mean(rows, axis=0)))
    for name, mean in means:
        print(f"{'MEAN ' + name:60} {_line(mean)}")


def _line(row):
    mean, largest, away, confidence, seconds = row
    return f"{mean:5.2f}  {largest:5.2f}  {away:4.0f}%  {confidence:5.2f} {seconds:7.1f}"


if __name__ == "__main__":
    main()
