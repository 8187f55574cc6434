# Two commands do everything: `make demo` and `make test`. `make help` lists the others.

VENV := .venv
BIN := $(VENV)/bin
LOCK := requirements.lock
STAMP := $(VENV)/.installed
ROBOT_LOCK := requirements-robot.lock
ROBOT := $(VENV)/.robot
COMPILE := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
  --no-emit-index-url --no-emit-find-links --no-header --no-annotate --extra voice --extra tui --extra dev
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps
INTERFACES := $(wildcard polaris_nl/execution/ros/interfaces/*/*/*)
VOICES := .venv-voices
THINKING := $(addprefix tests/,automaton interchange language model planning render repo scoring session)

.DEFAULT_GOAL := help
.PHONY: help demo test robot bench score-language score-speech lint format lock clean models

help: ## show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/' | expand -t 12

demo: $(STAMP) models ## speak, plan, run and review the caregiving program, without a robot
	@$(BIN)/polaris-nl demo

# Tests that only think share the cores. Robots, terminals and sound run in real time, so theirs come one by one.
test: $(ROBOT) models lint ## everything that CI checks
	$(BIN)/python -m pytest --numprocesses auto --maxprocesses 4 --dist worksteal $(THINKING)
	$(BIN)/python -m pytest $(addprefix --ignore=,$(THINKING))

robot: $(ROBOT) ## what `run --robot stretch-sim` needs: ROS 2, its messages, the simulator

bench: $(STAMP) models ## the speed table, beside the plain way
	@$(BIN)/python -m bench

score-language: $(STAMP) ## how much of what people say is understood, where the corpora are there
	@$(BIN)/python -m bench.score_language

score-speech: $(ROBOT) models $(VOICES)/.installed ## how well speech is understood, on a set that synthetic voices speak here
	@scripts/install-system voices
	@PYTHONPATH=. $(VOICES)/bin/python scripts/make_speech_set.py
	@$(BIN)/python -m bench.score_speech

$(VOICES)/.installed: scripts/voices.txt scripts/find-python
	@python=$$(PYTHON="$(PYTHON)" sh scripts/find-python) && "$$python" -m venv --clear $(VOICES)
	@$(VOICES)/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	@touch $@

lint: $(STAMP) ## style, types and import rules
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(STAMP) ## lay the code out
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

models: $(STAMP) ## fetch the speech model, unless it is there
	@$(BIN)/polaris-nl models

lock: $(STAMP) ## renew the locked versions and hashes
	$(BIN)/python -m pip install --quiet uv
	$(COMPILE) --output-file $(LOCK) pyproject.toml
	$(COMPILE) --extra ros --extra interfaces --extra sim --extra whisper --constraint $(LOCK) --output-file $(ROBOT_LOCK) pyproject.toml

clean: ## remove what was built
	rm -rf $(VENV) $(VOICES) build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# One environment serves demo, test and bench. It is made again when the lock or the project file changes.
$(STAMP): $(LOCK) pyproject.toml scripts/find-python
	@echo "Making the environment in $(VENV); this takes a minute or two, once."
	@python=$$(PYTHON="$(PYTHON)" sh scripts/find-python) && "$$python" -m venv --clear $(VENV)
	@$(INSTALL) --use-pep517 --require-hashes -r $(LOCK)
	@$(INSTALL) --no-build-isolation --editable .
	@touch $@

# ROS 2 and the simulator come on top, where they are wanted: they are several times as big as the rest.
# Whisper is with them, for the tests that compare it with Vosk.
$(ROBOT): $(STAMP) $(ROBOT_LOCK) scripts/build_interfaces.py $(INTERFACES)
	@echo "Adding ROS 2 and the simulator to $(VENV); this takes two or three minutes, once."
	@$(INSTALL) --use-pep517 --require-hashes -r $(ROBOT_LOCK)
	@$(BIN)/python scripts/build_interfaces.py --again
	@touch $@
