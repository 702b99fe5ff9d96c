# loopsheet: `make report` and `make test` do all of their own setting up. `make help` lists the rest.

PYTHON ?= python3
OUT ?= out
UV ?= uv==0.13.8
WORKERS ?= 3
SEED ?=
EACH ?=
PART ?=

VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
LOCK := .venv-lock/bin/uv pip compile --quiet --universal --python-version 3.11 \
	--fork-strategy fewest --generate-hashes --custom-compile-command "make lock" $(UPGRADE)
# Files go to the workers whole: the tests of one share what they made; the longest first (tests/conftest.py).
# Each worker has a processor for itself, and NumPy in it no further threads that wait for one another.
PYTEST := OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --numprocesses $(WORKERS) --dist loadfile --no-loadscope-reorder $(if $(SEED),--seed $(SEED))

# The tests begin hundreds of processes: each would compile the sources for itself.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help report test lint campaigns codes seen mutants bench docs wheel lock clean
.DELETE_ON_ERROR:
.NOTPARALLEL:

help:
	@echo 'make report      build the report of the shipped paper into $(OUT)/'
	@echo 'make test        ruff, mypy and all tests, with a few of the campaigns that are drawn at random'
	@echo 'make lint        ruff and mypy alone, with all that tests need set up'
	@echo 'make campaigns   all of these campaigns, and what was found in them (SEED=7: others)'
	@echo 'make codes       run cards in five simulation codes, a gigabyte, and in Yade and LIGGGHTS if there'
	@echo "make seen        the page's scripts or the paper's report were changed and looked at: they are right"
	@echo 'make mutants     one spot of the sources changed at a time: what no test notices (SEED=7, EACH=40, PART=plan)'
	@echo 'make bench       the benchmarks'
	@echo 'make docs        the guide and the reference as pages, in $(OUT)/docs/'
	@echo 'make wheel       loopsheet as one file in dist/, to be installed without this folder'
	@echo 'make lock        pin the dependencies of pyproject.toml again (UPGRADE=--upgrade: to the newest)'
	@echo 'make clean       remove all that was made here'
	@echo 'PYTHON=python3.12 make ... takes another interpreter (3.11 or later) for $(VENV)'
	@echo 'WORKERS=2 make ... tests in two processes instead of three'

report: $(VENV)/.runtime
	$(BIN)/loopsheet build paper --out '$(OUT)'
	@echo 'Look at $(abspath $(OUT))/report.html'

test: lint
	$(PYTEST)

lint: $(VENV)/.test .mypy_root/loopsheet
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy -p loopsheet

campaigns: $(VENV)/.test
	$(PYTEST) -m campaigns --campaigns all

codes: $(VENV)/.test
	$(PYTEST) -m codes tests/outside/test_codes.py

seen: $(VENV)/.test
	$(BIN)/python -m pytest -q --seen tests/outside/page/test_shortened.py tests/paper/test_paper_issued.py

mutants: $(VENV)/.test
	$(BIN)/python tests/mutants.py $(if $(SEED),--seed $(SEED)) $(if $(EACH),--each $(EACH)) $(PART)

bench: $(VENV)/.test $(VENV)/.bench
	set -e; for script in benchmarks/bench_*.py; do echo "== $$script"; $(BIN)/python "$$script"; done

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx -q -W --keep-going -E -b html docs '$(OUT)/docs' -d '$(OUT)/docs/.doctrees'
	@echo 'Look at $(abspath $(OUT))/docs/index.html'

# The stamps: an environment is set up once, and again when what it was made from has changed.
$(VENV)/.made:
	@$(PYTHON) -c 'import sys; sys.exit("loopsheet needs Python 3.11 or later, $(PYTHON) is %d.%d: make PYTHON=python3.11 ..." % sys.version_info[:2] if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv --clear $(VENV)
	@touch $@

# Each lock holds all of the runtime lock, so the larger one serves `make report` as well. The build
# backend is pinned with the rest: nothing is fetched that is not in the lock.
$(VENV)/.runtime $(VENV)/.test $(VENV)/.bench $(VENV)/.docs: $(VENV)/.%: requirements/%.txt pyproject.toml $(VENV)/.made
	$(PIP) install --require-hashes -r $<
	$(PIP) install --no-deps --no-build-isolation --no-index -e .
	@touch $@ $(VENV)/.runtime

# mypy reads the working files through this link, under the package's own name (see pyproject.toml).
.mypy_root/loopsheet:
	@mkdir -p $(@D) && ln -sfn .. $@

wheel: $(VENV)/.runtime
	@mkdir -p dist
	@$(BIN)/python -c 'from pathlib import Path; from loopsheet.report.archive.wheel import wheel; \
		name, content = wheel(); print(Path("dist", name)); Path("dist", name).write_bytes(content)'

lock: .venv-lock/bin/uv
	$(LOCK) pyproject.toml --group build -o requirements/runtime.txt
	$(LOCK) pyproject.toml --group build --group test -c requirements/runtime.txt -o requirements/test.txt
	$(LOCK) pyproject.toml --group build --group docs -c requirements/test.txt -o requirements/docs.txt
	$(LOCK) pyproject.toml --group build --group bench -c requirements/test.txt -c requirements/docs.txt -o requirements/bench.txt
	$(LOCK) --group crate -o requirements/crate.txt
	$(LOCK) --group codes -o requirements/codes.txt
	$(LOCK) pyproject.toml --resolution lowest-direct -o requirements/floors.txt

.venv-lock/bin/uv:
	$(PYTHON) -m venv --clear .venv-lock
	.venv-lock/bin/python -m pip --quiet install '$(UV)'

clean:
	rm -rf $(VENV) .venv-lock .mypy_root build dist *.egg-info '$(OUT)' .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
