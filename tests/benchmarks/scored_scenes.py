# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes whose truth only another program reads: it scores what is made of them, and a table says how others did."""

import argparse
import subprocess
import sys
from pathlib import Path


def scene_parser(description):
    """Make a parser of the options that all benchmarks of such scenes have."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=Path, required=True, help="folder with the scenes")
    parser.add_argument("--scorer", type=Path, required=True, help="the program that scores a result")
    parser.add_argument("--only", help="names of scenes, separated by commas (default all)")
    return parser


def chosen_scenes(options, suffix):
    """List the files of the scenes that are asked for."""
    names = options.only.split(",") if options.only else None
    return [path for path in sorted(options.scenes.glob(f"*{suffix}")) if names is None or path.stem in names]


def scored(scorer, scene, result, *more):
    """Heading and rows that the scorer prints."""
    command = [sys.executable, str(scorer), str(scene), str(result), *more]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def rows_of(scorer, table, scene, names):
    """Take the rows of others for a scene, by name, from a table beside the scorer, if there is one."""
    path = scorer.parent / table
    lines = path.read_text().splitlines() if path.exists() else []
    return {name: line for name in names for line in lines if line.split(" ")[0] == f"{scene}/{name}"}
