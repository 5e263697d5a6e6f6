# Two commands do everything on a fresh machine: `make figures` and `make test`.
# They need Python >= 3.11, a C++20 compiler and make; all else goes into .venv.
PYTHON  ?= python3
VENV    := .venv
BIN     := $(VENV)/bin
RUN     := $(BIN)/python
BUILD   := build
PIP     := pip install --quiet --disable-pip-version-check --no-compile
NEEDED  := $(PYTHON) tools/requirements.py
.DEFAULT_GOAL := help
# Or every process of the tests would compile all modules again.
unexport PYTHONDONTWRITEBYTECODE
.DELETE_ON_ERROR:

# ---- environment and build ------------------------------------------------------------------------------------
CORE_SOURCES := $(shell find src/core src/bindings -name '*.[ch]pp') \
                src/compile_options.cmake src/CMakeLists.txt src/core/CMakeLists.txt src/bindings/CMakeLists.txt
CPP_FILES := $(filter %.cpp %.hpp,$(CORE_SOURCES)) $(shell find tests -name '*.[ch]pp')

$(BUILD)/.venv: pyproject.toml
	@mkdir -p $(BUILD)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/$(PIP) $$($(NEEDED) build)
	@touch $@

$(BUILD)/.installed: $(BUILD)/.venv $(CORE_SOURCES)
	$(BIN)/$(PIP) --no-build-isolation --no-deps --editable .
	@touch $@

# What tests and checks need beside it.
$(BUILD)/.tests: $(BUILD)/.venv
	$(BIN)/$(PIP) $$($(NEEDED) dev distributed)
	@touch $@

.PHONY: build
build: $(BUILD)/.installed ## build the C++ core and install the package into .venv

# ---- figures, tests, checks -----------------------------------------------------------------------------------
include figures.mk

.PHONY: test
test: lint test-fast ## lint, and run all tests but the slow ones and those of the documents, on all cores

.PHONY: test-fast
test-fast: build $(BUILD)/.tests ## run these tests alone
	MAKEFLAGS= $(RUN) -m pytest -n auto -m "not slow and not more" --ignore tests/documents

.PHONY: test-slow
test-slow: build $(BUILD)/.tests ## run the tests that take seconds a case
	$(RUN) -m pytest -n auto -m "slow and not more" --ignore tests/documents

.PHONY: test-docs
test-docs: build $(BUILD)/.tests ## run the commands, examples and notebooks of README and docs, check pages, links, pictures
	$(RUN) -m pytest -n auto tests/documents

SITE := $(BUILD)/site
.PHONY: docs
docs: build gallery $(BUILD)/.docs ## build the documentation as a site that needs no network, into build/site
	$(RUN) -m sphinx --quiet --fresh-env --fail-on-warning --keep-going --nitpicky --builder html docs $(SITE)
	$(RUN) tools/check_site.py $(SITE)

$(BUILD)/.docs: $(BUILD)/.venv
	$(BIN)/$(PIP) $$($(NEEDED) docs frames graphs gis)
	@touch $@

.PHONY: test-all
test-all: test test-slow test-docs ## all tests, with all seeds
	$(RUN) -m pytest -n auto -m more --ignore tests/documents

.PHONY: lint
lint: build $(BUILD)/.tests ## ruff, mypy --strict, import-linter, clang-format, codespell
	$(BIN)/mypy & types=$$!; \
	$(BIN)/ruff check . && \
	$(BIN)/ruff format --check . && \
	$(BIN)/lint-imports --no-cache && \
	$(RUN) tools/public_names.py | diff $(STUBS)/__init__.pyi - && \
	$(RUN) tools/check_core.py && \
	$(BIN)/clang-format --dry-run --Werror $(CPP_FILES) && \
	$(BIN)/codespell; \
	others=$$?; wait $$types && exit $$others

.PHONY: tidy
tidy: $(BUILD)/.venv ## clang-tidy of the core, which takes minutes
	$(BIN)/$(PIP) 'clang-tidy>=18.1'
	tools/tidy.sh

.PHONY: format
format: $(BUILD)/.tests ## rewrite the sources in the project's format
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .
	$(BIN)/clang-format -i $(CPP_FILES)

STUBS := src/vorotool
.PHONY: stubs
stubs: build ## write the types of the compiled core (src/vorotool/_core/*.pyi) anew, from the core itself
	$(RUN) -m nanobind.stubgen --quiet --recursive --module vorotool._core --output-dir $(STUBS)

.PHONY: notebooks
notebooks: build $(BUILD)/.tests ## run the notebooks of docs
	$(RUN) -m pytest -n auto tests/documents/test_notebooks.py

.PHONY: bench
bench: build $(BUILD)/.tests ## measure beside the peers, in one run
	$(BIN)/$(PIP) $$($(NEEDED) bench)
	$(RUN) tests/benchmarks/tessellate.py
	$(RUN) tests/benchmarks/volumes.py
	$(RUN) tests/benchmarks/delaunay.py
	$(RUN) tests/benchmarks/space.py
	$(RUN) tests/benchmarks/alphashape.py
	$(RUN) tests/benchmarks/mesh_files.py
	$(RUN) tests/benchmarks/skeleton_exact.py
	$(RUN) tests/benchmarks/skeleton_approx.py
	$(RUN) tests/benchmarks/discs.py
	$(RUN) tests/benchmarks/masks.py
	$(RUN) tests/benchmarks/thickness.py
	$(RUN) tests/benchmarks/segment_voronoi.py
	$(RUN) tests/benchmarks/voronoi.py
	$(RUN) tests/benchmarks/distances.py
	$(RUN) tests/benchmarks/batch.py
	$(RUN) tests/benchmarks/libraries.py

.PHONY: fuzz
fuzz: build $(BUILD)/.tests ## all comparisons and harnesses: for MINUTES=... in all, or by counts (PIXELS=..., VOXELS=..., CASES=..., FAULTS=..., SEED=...)
ifdef MINUTES
	$(RUN) tests/fuzz/run.py together --minutes $(MINUTES) --seed $(or $(SEED),1)
else
	$(RUN) tests/fuzz/run.py tessellate --pixels $(or $(PIXELS),100000000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py spacing --pixels $(or $(PIXELS),100000000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py volumes --voxels $(or $(VOXELS),100000000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py predicates --calls $(or $(CALLS),1000000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py delaunay --cases $(or $(CASES),100000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py written --sets $(or $(SETS),10000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py cells --cases $(or $(CASES),20000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py alphashape --cases $(or $(CASES),20000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py alphashape_space --cases $(or $(CASES),10000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py digital --sets $(or $(SETS),500) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py planar_graph --cases $(or $(CASES),100000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py features --cases $(or $(CASES),20000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py skeletons --cases $(or $(CASES),100000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py skeleton_approx --cases $(or $(CASES),2000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py skeleton_bounds
	$(RUN) tests/fuzz/run.py pruning --cases $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py offsets --cases $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py discs --cases $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py rotation --cases $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py outlines --cases $(or $(CASES),20000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py thickness --cases $(or $(CASES),2000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py necks --cases $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py segment_voronoi --cases $(or $(CASES),800000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py segment_voronoi --cases 10000 --seed $(or $(SEED),1) --family clusters --largest 100 --symmetries 1
	$(RUN) tests/fuzz/run.py voronoi --cases $(or $(CASES),100000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py voronoi_cuts --cases $(or $(CASES),100000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py distances --cases $(or $(CASES),10000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py bytes --minutes 5 --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py streams --runs $(or $(CASES),1000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py features --cases $(or $(CASES),2000) --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py faults --kills $(or $(FAULTS),1000) --minutes 120 --seed $(or $(SEED),1)
	$(RUN) tests/fuzz/run.py machines --settings $(or $(MACHINES),40) --seed $(or $(SEED),1)
endif

.PHONY: long
long: build $(BUILD)/.tests ## frames, images and volumes far beyond memory: minutes, and some gigabytes of disk (SIDE=..., SEED=...)
	$(RUN) tests/long/big_tessellation.py --side 32768 --seeds 100000 --folder $(BUILD) --seed $(or $(SEED),1)
	$(RUN) tests/long/big_tessellation.py --side 32768 --seeds 30000 --folder $(BUILD) --seed $(or $(SEED),1) -- --cluster local
	$(RUN) tests/long/big_tessellation.py --side 30000 --seeds 60000 --image --table --folder $(BUILD) --seed $(or $(SEED),1)
	$(RUN) tests/long/big_tessellation.py --side $(or $(SIDE),131072) --folder $(BUILD) --seed $(or $(SEED),1)
	$(RUN) tests/long/big_volume.py --side $$(($(or $(SIDE),131072) / 32)) --folder $(BUILD) --seed $(or $(SEED),1)

OLDEST := $(BUILD)/oldest
.PHONY: test-oldest
test-oldest: ## run every test on the oldest versions that pyproject.toml allows, in an environment of their own
	rm -rf $(OLDEST)
	@mkdir -p $(OLDEST)
	$(PYTHON) -m venv $(OLDEST)/venv
	$(OLDEST)/venv/bin/$(PIP) $$($(NEEDED) --oldest build dev distributed zarr graphs)
	$(OLDEST)/venv/bin/$(PIP) --no-build-isolation --no-deps -C build-dir=$(OLDEST)/core --editable .
	PATH="$(CURDIR)/$(OLDEST)/venv/bin:$$PATH" $(OLDEST)/venv/bin/python -m pytest -n auto

.PHONY: wheel
wheel: $(BUILD)/.venv ## build sdist and wheel into build/dist, and try both in fresh environments, PYTHONS="python3.12 ..."
	$(RUN) tools/wheel.py $(PYTHONS)

.PHONY: warnings
warnings: $(BUILD)/.venv ## compile all C++ with each compiler here, COMPILERS="g++ ...", where a warning is an error
	COMPILERS="$(COMPILERS)" tools/warnings.sh $(RUN)

.PHONY: sanitize
sanitize: build $(BUILD)/.tests ## the suite on builds with sanitizers of threads, addresses and undefined behavior; then damaged files for MINUTES=...
	MINUTES=$(MINUTES) SEED=$(SEED) tools/sanitize.sh $(RUN)

.PHONY: clean
clean: ## remove what was built (.venv and build/)
	rm -rf $(BUILD) $(VENV)

.PHONY: help
help: ## show this list
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
