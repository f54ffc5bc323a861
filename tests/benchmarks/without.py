# SPDX-License-Identifier: GPL-3.0-or-later
"""Any other benchmark with mechanisms switched off, by their names in `ablation`.

    python -m tests.benchmarks.without "paired pieces,sheets" clothed --data FOLDER

What follows the benchmark's name are its own options.  All is done in one process, where what is switched off is off.
"""

import argparse
import os
import sys
from contextlib import ExitStack
from importlib import import_module

os.environ["HIERMATCH_PROCESSES"] = "1"

from tests.benchmarks.ablation import MECHANISMS, switched


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mechanisms", help=f"what to switch off, of {', '.join(MECHANISMS)}")
    parser.add_argument("benchmark", help="module of tests.benchmarks")
    parser.add_argument("options", nargs=argparse.REMAINDER, help="its options")
    chosen = parser.parse_args()
    benchmark = import_module(f"tests.benchmarks.{chosen.benchmark}")
    sys.argv = [chosen.benchmark, *chosen.options]
    with ExitStack() as off:
        for name in filter(None, chosen.mechanisms.split(",")):
            off.enter_context(switched(*MECHANISMS[name]))
        benchmark.main()


if __name__ == "__main__":
    main()
