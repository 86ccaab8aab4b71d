# `make demo` and `make test` are the two that matter; each prepares what it needs in .venv.

VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/installed
LOCK := requirements/lock.txt

.PHONY: demo test format wheel lock install-service uninstall-service clean help

help:
	@echo 'make demo    the paper'"'"'s experiment between two processes on a CAN bus'
	@echo 'make test    every check and every test'
	@echo 'make format  mend what ruff can'
	@echo 'make wheel   dist/*.whl'
	@echo 'make lock    pin the newest dependencies pyproject.toml allows'
	@echo 'make install-service, make uninstall-service   systemd units and /opt/tcs-hil (as root)'
	@echo 'make clean   remove .venv and everything built'

demo: $(STAMP)
	$(BIN)/tcs-hil demo

test: $(STAMP)
	scripts/check $(BIN)

format: $(STAMP)
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .

wheel: $(STAMP)
	$(BIN)/python -m build --wheel --no-isolation

lock: $(STAMP)
	$(BIN)/python -m pip install --quiet uv
	$(BIN)/uv pip compile pyproject.toml --all-extras --group dev --output-file $(LOCK) \
	    --universal --python-version 3.11 --generate-hashes --upgrade --no-config \
	    --no-emit-index-url --no-annotate --custom-compile-command 'make lock'

install-service:
	scripts/install-service install

uninstall-service:
	scripts/install-service uninstall

$(STAMP): pyproject.toml $(LOCK) scripts/make-venv
	scripts/make-venv $(VENV) $(LOCK)
	@touch $@

clean:
	rm -rf $(VENV) build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis \
	    .import_linter_cache
	find tcs_hil plant_emulator tests scripts -name __pycache__ -prune -exec rm -rf {} +
