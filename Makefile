# Everything the project does, by name: `make help`. The program knows which studies a figure or table needs: with
# `--run` it computes those that are missing, or whose numbers something has changed, and writes what is out of date.

PYTHON ?= python3
# Kernels of OpenBLAS for `make kernels`: one that every x86-64 processor runs. On another, all that it runs:
# make kernels KERNELS="Nehalem Haswell Zen SkylakeX"
KERNELS ?= Nehalem
VENV := .venv
SEED ?= 0
N ?= 100
READY := $(VENV)/.ready
RUN := $(VENV)/bin/python -m study
# As many processes as processors, but no more than pays; one that is done takes tests from another. Compiled modules are
# kept, whatever the environment says: tests start some hundred processes, of which each would compile them anew.
PYTEST := PYTHONDONTWRITEBYTECODE= $(VENV)/bin/python -m pytest -q --numprocesses logical --maxprocesses 8 --dist worksteal

.DEFAULT_GOAL := help
.PHONY: always $(shell sed -n 's/^\([a-z0-9_-]*\): .*/\1/p' Makefile)
.NOTPARALLEL:
.DELETE_ON_ERROR:
.PRECIOUS: results/%.nc

help: ## this list
	@awk -F ':.*## ' '/^[a-z0-9_-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' Makefile

setup: $(READY) ## install the pinned packages and roughcoat into .venv

figures: $(READY) ## the paper's figures, those on the exact layer and of lattices, validity, coatings, captions: figures/*
	$(RUN) plot --run all

table1: tables/table1.txt ## Table 1 of the paper, printed and refitted: tables/table1.txt, .csv, .tex
paper_numbers: tables/paper_numbers.txt ## every number the paper prints beside ours
validity: tables/validity.txt ## up to which h/a the thin-layer model errs by less than 1 % and 10 %
extremes: figures/extremes.pdf tables/extremes.txt ## 102,000 random cases far beyond any scene: status, error, iterations
table1 paper_numbers validity extremes:
	@cat tables/$@.txt

map: $(READY) ## 25,000 cases for exploration: results/parameter_map.nc
	$(RUN) run parameter_map

tradeoff: figures/tradeoff.pdf ## error against time of every way to solve: docs/tradeoff_measured.txt, tradeoff.png
	$(RUN) table --run tradeoff tradeoff_cheapest tradeoff_factors paper_error
	@cp figures/tradeoff.png docs/
	@for name in tradeoff_cheapest tradeoff_factors paper_error; do cat tables/$$name.txt; echo; done | \
	  tee docs/tradeoff_measured.txt

picard_domain: figures/picard_domain.pdf ## where the paper's successive approximations converge: figures/picard_domain.*

literature: figures/literature.pdf figures/yielding.pdf ## published formulas beside the exact layer, and their safe ranges: docs/literature.md, .png
	$(RUN) table --run literature literature_coatings literature_decided literature_rough literature_shapes \
	  literature_pull_off
	@cp figures/literature.png figures/yielding.png docs/
	$(VENV)/bin/python tools/literature_page.py docs/literature.md

yield_maps: $(READY) ## where coated bodies first yield, and what fails first of DLC on steel: docs/stresses.md, .png
	$(RUN) plot --run first_yield what_fails_first which_layer_first
	@cp figures/first_yield.png figures/what_fails_first.png figures/which_layer_first.png docs/
	@$(RUN) point --stresses docs/stresses.png R="5 mm" punch="steel 52100" layer="DLC ta-C" h="20 um" bonding=bonded \
	  body=PEEK P="10 N" micro=smooth >/dev/null

validate: $(READY) ## rough spheres with every asperity resolved beside the two scales: docs/validate.md, .nc, .png
	$(VENV)/bin/python tools/resolved/validate.py docs

# Sphinx and its themes are no part of the pinned packages: their versions do not change what is said.
docs: $(READY) ## the site of the documentation, with a gallery: docs/_build/html/index.html, opened from disk
	$(VENV)/bin/python -m pip install --quiet --editable '.[docs]' --no-build-isolation
	$(VENV)/bin/sphinx-build --quiet -W -n --keep-going -c docs/site docs docs/_build/html
	@echo docs/_build/html/index.html

# The tests of the site need what `make docs` and `make explorer-test` install.
docs-test: docs ## the tests of the site: links, search, widths of pages, notebooks
	$(VENV)/bin/python -m pytest -q --verify tests/site

test: $(READY) ## the tests, in some minutes; what each room may cost is in tests/budget.toml
	$(PYTEST) --budget

verify: $(READY) ## all tests, on other kernels, with the lowest versions, of the explorer in a browser; the docs (an hour)
	$(PYTEST) --verify
	@$(MAKE) --no-print-directory kernels ALL=--verify
	@$(MAKE) --no-print-directory lowest
	@$(MAKE) --no-print-directory explorer-test
	@$(MAKE) --no-print-directory docs-test

# Debian's node and chromium; without them these tests are skipped.
explorer-test: $(READY) ## install node, chromium and playwright, and test the page of `roughcoat explore` with them
	@command -v node >/dev/null && command -v chromium >/dev/null || \
	  apt-get install --yes --no-install-recommends nodejs chromium
	$(VENV)/bin/python -m pip install --quiet --editable '.[explorer]' --no-build-isolation
	EXPLORER_EVERY=1 $(VENV)/bin/python -m pytest -q -s --verify tests/explorer

# Of each room what is quick, against references where there are any: no test that starts Python anew, or that takes
# the shrunken results of all studies, which are twenty seconds of computing.
check: $(READY) lint ## for the inner loop: lint, and the tests in tests/quick.txt, which take half a minute
	$(PYTEST) @tests/quick.txt

# The rooms that compute: golden numbers, error bars and limits, which depend on rounding. Left out are long samples of the
# same, what rounding does not reach (messages, errors of models), and, but for its golden numbers, the compiled core, which
# calls no BLAS.
kernels: $(READY) ## the tests in tests/computing.txt under the BLAS kernels of other processors
	@for kernel in $(KERNELS); do echo "OPENBLAS_CORETYPE=$$kernel"; \
	  OPENBLAS_CORETYPE=$$kernel $(PYTEST) $(ALL) @tests/computing.txt || exit 1; done

lowest: ## all tests with the lowest versions that pyproject.toml allows, installed into .venv-lowest
	$(PYTHON) -m venv .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --only-binary :all: $$($(PYTHON) tools/lowest.py)
	.venv-lowest/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@touch .venv-lowest/.ready
	@$(MAKE) --no-print-directory test VENV=.venv-lowest

# Of the rooms that have changed since a commit alone: make mutants SEED=1 N=50 BASE=HEAD~3
mutants: $(READY) ## N mistakes that the program makes, drawn by SEED: which do the tests notice? docs/mutants.md
	$(VENV)/bin/python tools/mutants/mutate.py --seed $(SEED) --number $(N) $(if $(BASE),--base $(BASE))

# SANITIZED: the options of the compiler; the tests build the core with them. Debian: clang, libclang-rt-14-dev.
SANITIZED := -fsanitize=address,undefined -fno-sanitize-recover=all -g
sanitize: export ASAN_OPTIONS := detect_leaks=0
sanitize: $(READY) ## the compiled core under AddressSanitizer and UndefinedBehaviorSanitizer, by gcc and by clang
	CC=gcc CFLAGS="$(SANITIZED)" LDFLAGS="$(SANITIZED)" LD_PRELOAD=$$(gcc -print-file-name=libasan.so) \
	  $(VENV)/bin/python -m pytest -q -s --verify tests/compiled
	@command -v clang >/dev/null || { echo "clang is not installed: the core was tried under gcc alone"; exit 2; }
	CC=clang LDSHARED="clang -shared -shared-libsan" CFLAGS="$(SANITIZED) -shared-libsan" LDFLAGS="$(SANITIZED)" \
	  LD_PRELOAD=$$(clang -print-file-name=libclang_rt.asan-$$(uname -m).so) \
	  $(VENV)/bin/python -m pytest -q -s --verify tests/compiled -k sse2

fuzz: $(READY) ## random calls, mutated study files, flipped bits: nothing crashes, nothing is silently wrong (minutes)
	$(VENV)/bin/python tools/fuzz/fuzz_solver.py --cases 4800
	$(VENV)/bin/python tools/fuzz/fuzz_shapes.py 100
	$(VENV)/bin/python tools/fuzz/fuzz_studies.py 2000
	$(VENV)/bin/python tools/fuzz/fuzz_files.py 400
	$(VENV)/bin/python tools/fuzz/kill_runs.py 10
	$(VENV)/bin/python tools/fuzz/kill_runs.py 10 1 parts

bench: $(READY) ## speed of the solver: bench.json
	$(VENV)/bin/python tools/bench/benchmark.py bench.json
	$(VENV)/bin/python tools/fields/benchmark_fields.py
	$(VENV)/bin/python tools/fields/benchmark_extremes.py
	$(VENV)/bin/python tools/fields/benchmark_shapes.py
	$(VENV)/bin/python tools/fit/benchmark_fits.py

speed: $(READY) ## speeds of what people run, on an idle machine: docs/speed.md; ONLY="fits stresses": these sections
	$(VENV)/bin/python tools/bench/benchmark.py --page docs/speed.md $(if $(ONLY),--only $(ONLY))

start: $(READY) ## what a command and a call take before they compute, in units of `import xarray`: the table of docs/speed.md
	$(VENV)/bin/python tools/start/benchmark_start.py

fit_coverage: $(READY) ## how right `rc.fit` is, and how fast, on 10,000 curves: the table of docs/fit.md
	$(VENV)/bin/python tools/fit/coverage.py

lint: $(READY) ## ruff, and mypy for the public names
	$(VENV)/bin/ruff check .
	$(VENV)/bin/mypy

clean: ## remove figures and tables that the program draws, and caches; results and .venv stay
	@if [ -x $(VENV)/bin/python ]; then $(VENV)/bin/python tools/clean.py; fi

# Wheels only: a compiler is needed for nothing, and used for the optional core of the solver. Modules are compiled, as
# pip does with a wheel, even where Python shall not write what it compiles. setuptools is one of the pinned packages. A Python newer than the lock has no wheels of some pinned versions; there pip takes the newest ones.
$(READY): requirements.lock pyproject.toml $(wildcard setup.py solver/compiled/*.c solver/compiled/*.h)
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "roughcoat needs Python 3.11 or newer; name one: make setup PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --only-binary :all: --requirement requirements.lock || \
	  { echo "requirements.lock does not fit this Python: the newest versions are installed, not the pinned ones"; \
	    $(VENV)/bin/python -m pip install --quiet --prefer-binary setuptools --editable '.[cluster,test,lint]'; }
	$(VENV)/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	$(VENV)/bin/python -m compileall -q roughcoat solver study studies
	@$(VENV)/bin/python -P -m roughcoat --version
	@touch $@

# A study whose results are there and right computes nothing.
results/%.nc: always | $(READY)
	$(RUN) run $*

figures/%.pdf: always | $(READY)
	$(RUN) plot --run $*

tables/%.txt: always | $(READY)
	$(RUN) table --run $*
