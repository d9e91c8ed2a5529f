# `make demo` and `make test` need Python 3.11 or newer and nothing else.
PYTHON ?= python3
BIN := .venv/bin
SOURCES := trsim tests benchmarks
# one process for each processor; whoever is done takes tests from the others
PYTEST := $(BIN)/python -m pytest --numprocesses auto --dist worksteal --durations 10

.PHONY: demo paper door tolerances gallery docs docs-check test release-check coverage portable elsewhere lint bench stress truth mutants wheel clean

demo: .venv/installed
	$(BIN)/trsim run scenarios/thrust_reverser/clearance_ab_0.3mm.yaml -o runs/demo.h5
	$(BIN)/trsim report runs/demo.h5 -o runs/demo

# every configuration of the published study, those with impacts as ensembles, and a page with a verdict
# on each of its claims; rerun it to resume
paper: .venv/installed
	$(BIN)/trsim sweep scenarios/thrust_reverser/paper.yaml -o runs/paper
	$(BIN)/trsim report --paper thrust-reverser runs/paper -o runs/paper/page

# every load case of the published study of a crew door, and a page with a verdict on each of its statements
# and the critical envelopes; rerun it to resume
door: .venv/installed
	$(BIN)/trsim sweep scenarios/crew_door/door.yaml -o runs/door
	$(BIN)/trsim report --paper crew-door runs/door -o runs/door/page

# 896 runs; rerun it to resume
tolerances: .venv/installed
	$(BIN)/trsim sweep scenarios/thrust_reverser/tolerances.yaml -o runs/tolerances
	$(BIN)/trsim report runs/tolerances --sobol peak:B.contact_force \
	  --sobol "peak:A.contact_force@0.29..0.5" --sobol "peak:actuator.force@0.5..1" \
	  --sobol "fluctuation:door_angle.rate@0.31..0.98"

# pictures and page of docs/gallery.md, and the pictures of docs/first_mechanism.md
gallery: .venv/developer
	$(BIN)/python -m benchmarks.gallery

# tables and figures of README and docs that are stale; rerun it to resume. What measures times,
# takes long or is copied by hand is left unless named: make docs NAMES="turns rods"
docs: .venv/developer
	$(BIN)/python -m benchmarks.docs $(NAMES)

# names what is stale, and fails if anything is
docs-check: .venv/developer
	$(BIN)/python -m benchmarks.docs --check

test: .venv/developer lint
	$(PYTEST)

# ten times the mutants, kills, faults and rows: half an hour to an hour; rerun it to resume
release-check: .venv/developer lint
	TRSIM_SIZE=release $(PYTEST)

# lines of elements and laws that quick tests reach, compiled functions as plain Python: minutes
coverage: .venv/developer
	TRSIM_PYTHON=1 $(BIN)/python -m coverage run -m pytest tests/elements tests/laws \
	  --ignore tests/laws/test_cable_beams.py
	$(BIN)/python -m coverage report

# the numerical part under other arithmetics than the machine's own; rerun it to resume
portable: .venv/developer
	$(BIN)/python -m tests.portable

# commands, sweeps, files and machine code without what only POSIX has: fcntl, fork, signals and others
elsewhere: .venv/developer
	$(BIN)/python -m tests.elsewhere --numprocesses auto --dist worksteal --durations 10

lint: .venv/developer
	$(BIN)/ruff format --check $(SOURCES)
	$(BIN)/ruff check $(SOURCES)
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: .venv/developer
	$(BIN)/python -m benchmarks

# goes on where it was ended; a fresh start: rm -r runs/stress
stress: .venv/developer
	$(BIN)/python -m benchmarks.stress

.venv/bin/python:
	$(PYTHON) -m venv .venv

.venv/installed: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

.venv/developer: .venv/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --editable ".[dev]"
	touch $@ .venv/installed

# scenes drawn with the commit's hash, each judged independently; rerun it to resume
truth: .venv/developer
	$(BIN)/python -m tests.truth
	$(BIN)/python -m tests.truth --table

# a wheel that compiles nothing on common processors, for this Python and others, as in
# make wheel PYTHONS="python3.12 python3.13"; rerun it to resume
wheel: .venv/installed
	$(BIN)/python -m trsim.kernels.carry build/carried
	for python in $(PYTHONS); do \
	  $$python -m venv build/$$python && \
	  build/$$python/bin/python -m pip install --quiet --editable . && \
	  build/$$python/bin/python -m trsim.kernels.carry --keys build/carried || exit 1; \
	done
	TRSIM_CARRIED=build/carried $(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir dist .

# faults put into the sources, and those that no test notices; rerun it to resume
mutants: .venv/developer
	$(BIN)/python -m tests.mutants

clean:
	rm -rf .venv build dist *.egg-info
