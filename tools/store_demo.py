# SPDX-License-Identifier: GPL-3.0-or-later
"""Demo cats in their usual sizes, written as the file that the extension adds them from.

    python -m tools.store_demo

To be run when `hiermatch_addon/demo` builds them in another way.
"""

from __future__ import annotations

import importlib
from typing import Any

from tools.source_extension import PACKAGE, load_extension


def main() -> None:
    """Build the cats, and write them."""
    load_extension()
    pair: Any = importlib.import_module(f"{PACKAGE}.hiermatch_addon.demo.demo_pair")
    store: Any = importlib.import_module(f"{PACKAGE}.hiermatch_addon.demo.demo_store")
    path = store.save_cats(pair.build_cats(*store.STORED_SIZES))
    print(f"{path}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
