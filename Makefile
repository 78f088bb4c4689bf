# Everything runs in .venv, which the first target makes.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# The machine is for the tests, not for idle threads of the linear algebra.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

.PHONY: tour test test-heavy test-browser test-firefox test-neighbours docs docs-outputs docs-map lint bench bench-large audit fuzz clean

$(VENV)/.installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"
	$(BIN)/python -m pip install --quiet --editable ".[all]" --group test
	touch $@

tour: $(VENV)/.installed  ## the whole of it on the embedded shape; results in ./tour
	$(BIN)/beltrami tour -o tour

test: $(VENV)/.installed  ## lint, types, import rule and every unmarked test; what fails twice, to say how
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy & types=$$!; \
	$(BIN)/python -m pytest -n auto --dist worksteal --assert plain || \
	  { failed=yes; $(BIN)/python -m pytest --last-failed --last-failed-no-failures none; }; \
	wait $$types && test -z "$$failed"

test-heavy: $(VENV)/.installed  ## fuzzing at length, millions of vertices
	$(BIN)/python -m pytest -m heavy

$(VENV)/.browser: $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --group browser
	touch $@

test-browser: $(VENV)/.browser  ## the pages in a real Chromium, and their modules in node
	$(BIN)/python -m pytest -m browser $$(grep -rl --include='*.py' 'mark\.browser' tests)

test-firefox: $(VENV)/.browser  ## the pages in a real Firefox, on a screen of Xvfb
	$(BIN)/python -m pytest -m firefox $$(grep -rl --include='*.py' 'mark\.firefox' tests)

test-neighbours:  ## cards in IPython, meshes through pyvista, open3d, polyscope and S3: half a gigabyte
	$(PYTHON) -m venv .venv-neighbours
	.venv-neighbours/bin/python -m pip install --quiet --upgrade "pip>=25.1"
	.venv-neighbours/bin/python -m pip install --quiet --editable ".[all,view]" --group neighbours
	.venv-neighbours/bin/python -m pytest -p no:dash tests/mesh/test_neighbours.py tests/display/test_cards.py \
	  tests/batch/test_s3.py

docs: $(VENV)/.installed  ## the site, in site/; a warning is an error
	$(BIN)/python -m pip install --quiet --group docs
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet docs site

docs-outputs: $(VENV)/.installed  ## what the code on the pages prints, as it stands below it
	$(BIN)/python docs/outputs.py

docs-map:  ## docs/chapter-map.md, from the markers in the code and in the tests
	$(PYTHON) docs/chapter_map.py

bench:  ## against the peers, in an environment of their own; writes BENCHMARKS.md
	$(PYTHON) -m venv .venv-bench
	.venv-bench/bin/python -m pip install --quiet --upgrade "pip>=25.1"
	.venv-bench/bin/python -m pip install --quiet --editable ".[all]" --group bench
	-.venv-bench/bin/python -m pip install --quiet --group bench-cholmod  # Debian: libsuitesparse-dev
	.venv-bench/bin/python -m benchmarks

audit: $(VENV)/.installed  ## bill of materials (dist/sbom.json); fails on what is vulnerable or unknown
	$(PYTHON) -m venv .venv-audit
	.venv-audit/bin/python -m pip install --quiet --upgrade "pip>=25.1"
	.venv-audit/bin/python -m pip install --quiet --group audit
	mkdir -p dist
	.venv-audit/bin/cyclonedx-py environment --pyproject pyproject.toml -o dist/sbom.json $(BIN)/python
	$(BIN)/python -m pip freeze --exclude-editable > dist/installed.txt
	.venv-audit/bin/pip-audit --strict --no-deps --disable-pip -r dist/installed.txt

FORMATS ?= obj off ply stl btm csv npy npz gz gii vtu vtp
SECONDS ?= 60
fuzz: $(VENV)/.installed  ## readers, by Atheris, with bounds checked; finds stay in .fuzz
	$(BIN)/python -m pip install --quiet --group fuzz
	for format in $(FORMATS); do \
	  PYTHONPATH=tests NUMBA_BOUNDSCHECK=1 NUMBA_CACHE_DIR=.fuzz-cache \
	    $(BIN)/python -m fuzz $$format $(SECONDS) || exit 1; \
	done

bench-large:  ## solver and spectra to 2.1M vertices, after `make bench`; writes BENCHMARKS-LARGE.md
	.venv-bench/bin/python -m benchmarks --large

clean:
	rm -rf $(VENV) .venv-bench .venv-neighbours .venv-audit .fuzz .fuzz-cache tour site dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
