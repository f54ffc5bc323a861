#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Print the first CPython 3.11 that can make an environment, or say in one sentence why there is none.
#   tools/find_python.sh [CANDIDATE]    a candidate given is the only one tried
set -u
check='import ensurepip, platform, sys, venv
sys.exit(not (sys.version_info[:2] == (3, 11) and platform.python_implementation() == "CPython"))'

if [ -n "${1:-}" ]; then set -- "$1"; else set -- python3.11 python3 python; fi
for candidate; do
    if "$candidate" -c "$check" >/dev/null 2>&1; then
        command -v "$candidate"
        exit 0
    fi
done

echo "HierMatch is developed with CPython 3.11 and its venv module (Blender as a Python module runs on no other), and found" \
    "it under no such name as $*: please install it or, if its name is another, say make PYTHON=/path/to/python3.11" >&2
exit 1
