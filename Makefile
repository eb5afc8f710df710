# Everything the project does, by name: `make help`. A finished result is computed again only when what determines its
# numbers has changed: make calls `study run`, which compares digests.

PYTHON ?= python3
STUDIES := table1 reference_load main_case load_sweep spot_density parameter_map validity validity_load coatings \
  extremes extremes_layered picard_domain
PAPERS := fig01 fig02 fig03 fig04 fig05 fig06 fig07 fig08 fig09 fig10
COMPANIONS := fig03_layered fig04_layered fig05_layered fig06_layered fig07_layered fig08_layered fig10_layered
FIGURES := $(PAPERS) $(COMPANIONS) validity validity_load coatings
# With a target of their own: long to compute.
APART := extremes picard_domain tradeoff
DRAWN := table1 main_case load_sweep spot_density validity validity_load coatings
TABLES := table1 paper_numbers validity extremes tradeoff

# Kernels of OpenBLAS for `make kernels`: one that every x86-64 processor runs. On another, all that it runs:
# make kernels KERNELS="Nehalem Haswell Zen SkylakeX"
KERNELS ?= Nehalem
VENV := .venv
READY := $(VENV)/.ready
RUN := $(VENV)/bin/python -m study
# As many processes as processors, but no more than pays; one that is done takes tests from another.
PYTEST := $(VENV)/bin/python -m pytest -q --numprocesses logical --maxprocesses 8 --dist worksteal
SOURCES := $(wildcard solver/*.py solver/*/*.py study/*.py study/*/*.py)

.DEFAULT_GOAL := help
.PHONY: help setup figures table1 paper_numbers validity map extremes tradeoff picard_domain test kernels mutants fuzz bench lint clean
.NOTPARALLEL:
.SECONDARY:
.DELETE_ON_ERROR:
.PRECIOUS: results/%.nc

help: ## this list
	@awk -F ':.*## ' '/^[a-z0-9_]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' Makefile

setup: $(READY) ## install the pinned packages and roughcoat into .venv

figures: figures/.drawn ## the paper's figures 1 to 10, those on the exact layer, validity, coatings: figures/*
	@$(MAKE) --silent --no-print-directory $(FIGURES:%=figures/%.pdf)

table1: tables/table1.txt ## Table 1 of the paper, printed and refitted: tables/table1.txt, .csv, .tex
	@cat $<

paper_numbers: tables/paper_numbers.txt ## every number the paper prints beside ours
	@cat $<

validity: tables/validity.txt ## up to which h/a the thin-layer model errs by less than 1 % and 10 %
	@cat $<

map: results/parameter_map.nc ## 25,000 cases for exploration: results/parameter_map.nc

extremes: figures/extremes.pdf tables/extremes.txt ## 102,000 random cases far beyond any scene: status, error, iterations
	@cat tables/extremes.txt

tradeoff: figures/tradeoff.pdf tables/tradeoff.txt docs/tradeoff.md ## error against time of every way to solve: docs/tradeoff.md, .png
	@cp figures/tradeoff.png docs/
	@cat docs/tradeoff.md

picard_domain: figures/picard_domain.pdf ## where the paper's successive approximations converge: figures/picard_domain.*

test: $(READY) ## all tests
	$(PYTEST)

kernels: $(READY) ## the tests that import the solver, under the BLAS kernels of other processors
	@for kernel in $(KERNELS); do echo "OPENBLAS_CORETYPE=$$kernel"; \
	  OPENBLAS_CORETYPE=$$kernel $(PYTEST) $$(grep -l '^from solver' tests/*/test_*.py) || exit 1; done

mutants: $(READY) ## which of some 400 small mistakes in the code the tests notice: docs/mutants.md
	$(VENV)/bin/python tests/mutate.py --table docs/mutants.md

fuzz: $(READY) ## random calls, mutated study files, flipped bits: nothing crashes, nothing is silently wrong (an hour)
	$(VENV)/bin/python tests/fuzz_solver.py
	$(VENV)/bin/python tests/fuzz_studies.py
	$(VENV)/bin/python tests/fuzz_files.py

bench: $(READY) ## speed of the solver: bench.json
	$(VENV)/bin/python tests/benchmark.py bench.json

lint: $(READY) ## ruff
	$(VENV)/bin/ruff check .

clean: ## remove figures, tables and caches; results and .venv stay
	rm -f $(foreach name,$(FIGURES) $(APART),$(addprefix figures/$(name).,pdf png csv))
	rm -f $(foreach name,$(TABLES),$(addprefix tables/$(name).,txt csv tex)) bench.json figures/.drawn
	rm -rf .pytest_cache .ruff_cache .hypothesis
	find solver study tests -name __pycache__ -type d -prune -exec rm -rf {} +

# Wheels only: nothing is compiled on the user's machine. setuptools is one of the pinned packages.
$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "roughcoat needs Python 3.11 or newer; name one: make setup PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --only-binary :all: --requirement requirements.lock
	$(VENV)/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
	@touch $@

# `run` computes nothing when the digest of the results is still right; touch then tells make so. The studies of this
# repository may replace their own results of an older version (--force); with a study of your own the change is
# reported, and replacing is your decision.
results/%.nc: studies/%.toml $(SOURCES) | $(READY)
	$(RUN) run $(if $(filter $*,$(STUDIES)),--force) $<
	@touch $@

# Measured, not computed: anew only for other numerics or other settings.
docs/tradeoff.md: results/tradeoff.nc
results/tradeoff.nc docs/tradeoff.md: $(SOURCES) | $(READY)
	$(RUN) tradeoff
	@touch $@

figures/fig01.pdf figures/fig02.pdf figures/fig03.pdf figures/fig07.pdf: results/main_case.nc
figures/fig03_layered.pdf figures/fig07_layered.pdf: results/main_case.nc
figures/fig04.pdf figures/fig05.pdf figures/fig06.pdf figures/fig08.pdf: results/load_sweep.nc results/main_case.nc
figures/fig04_layered.pdf figures/fig05_layered.pdf: results/load_sweep.nc results/main_case.nc
figures/fig06_layered.pdf figures/fig08_layered.pdf: results/load_sweep.nc results/main_case.nc
figures/fig09.pdf: results/table1.nc
figures/fig10.pdf figures/fig10_layered.pdf: results/spot_density.nc
figures/validity.pdf: results/validity.nc
figures/validity_load.pdf: results/validity_load.nc
figures/coatings.pdf: results/coatings.nc
figures/picard_domain.pdf: results/picard_domain.nc
figures/tradeoff.pdf: results/tradeoff.nc
figures/extremes.pdf: results/extremes.nc results/extremes_layered.nc
figures/%.pdf: study/figures/roughcoat.mplstyle | $(READY)
	$(RUN) plot $*

# All in one process: most of the time of a figure goes into starting Python. What has been deleted since, `figures`
# draws one by one.
figures/.drawn: $(DRAWN:%=results/%.nc) study/figures/roughcoat.mplstyle | $(READY)
	$(RUN) plot $(FIGURES)
	@touch $@

tables/table1.txt: results/table1.nc
tables/paper_numbers.txt: results/reference_load.nc results/main_case.nc results/table1.nc
tables/validity.txt: results/validity.nc results/validity_load.nc
tables/tradeoff.txt: results/tradeoff.nc
tables/extremes.txt: results/extremes.nc results/extremes_layered.nc
tables/%.txt: $(SOURCES) | $(READY)
	$(RUN) table $*
