# SPDX-License-Identifier: GPL-3.0-or-later
# Every everyday command, on Linux or macOS, from a fresh clone with CPython 3.11 and access to PyPI.  Try `make help`.

# Interpreter for a new environment; empty: the first suitable one of python3.11, python3 and python.
PYTHON =
# The first pip to install dependency groups is 25.1; a pinned one makes every machine resolve alike.
PIP = pip==26.3
RUN = .venv/bin/python

.PHONY: help demo test lint types package package-no-wheels environment bench-environment python-check clean distclean

help:
	@echo 'make demo               match a demo pair in Blender: build/demo/demo.blend, demo.png and a table'
	@echo 'make test               run all tests (pytest -m "not slow" for the quick ones)'
	@echo 'make lint               check style and formatting with ruff'
	@echo 'make types              check types with mypy'
	@echo 'make package            build and validate an extension zip per platform in build/package'
	@echo 'make package-no-wheels  the same without SciPy, for a Blender that has its own: build/package-no-wheels'
	@echo 'make bench-environment  add what benchmarks compare with; then e.g. .venv/bin/python -m tests.benchmarks.real_pairs'
	@echo 'make clean              remove what was built, and caches'
	@echo 'make distclean          remove the environments and downloaded wheels too'
	@echo 'All of them first make .venv, once.  PYTHON=... names the CPython 3.11 to use for it.'

demo: environment
	$(RUN) tools/demo.py

# As many tests at once as there are cores, so each has one; what a file of tests prepares is prepared once.
test: environment
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 HIERMATCH_PROCESSES=1 $(RUN) -m pytest --numprocesses auto --maxprocesses 4 --dist loadfile

lint: environment
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .

types: environment
	$(RUN) -m mypy

package: environment
	$(RUN) -m tools.build_package

package-no-wheels: environment
	$(RUN) -m tools.build_package --without-wheels

bench-environment: environment
	$(RUN) -m pip install --quiet --disable-pip-version-check --group bench

environment: $(if $(PYTHON),python-check) .venv/installed

# A Python named by hand is checked even if the environment exists already, rather than silently not used.
python-check:
	@sh tools/find_python.sh '$(PYTHON)' >/dev/null

.venv/installed: pyproject.toml
	@python="$$(sh tools/find_python.sh '$(PYTHON)')" && "$$python" -m venv .venv
	@echo 'Installing the development tools into .venv (once; Blender as a module is the large one).'
	$(RUN) -m pip install --quiet --disable-pip-version-check '$(PIP)'
	$(RUN) -m pip install --disable-pip-version-check --group dev
	@mkdir -p .venv/extension && ln -sfn ../.. .venv/extension/hiermatch  # see [tool.mypy] in pyproject.toml
	@touch $@

clean:
	rm -rf build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . \( -path ./.venv -o -path ./.envs \) -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean
	rm -rf .venv .envs wheels
