# Two commands do everything on a machine with Python 3.11 or later, make and git:
#   make build    environment, installation, the Macbeth cube at dim 32, its slices, one query
#   make test     environment, installation, all checks
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
OUT := out
PIP := $(BIN)/pip install -qq --disable-pip-version-check
AXE := $(OUT)/axe/axe_playwright_python/axe.min.js

.PHONY: golden golden-before build environment lint test bare basic site bench peers accuracy study prior library stability nightly determinism munsell docs atlases samples cubes lock clean demo-render textures chart scenes plan pictures wavelengths representations mixing display palette look-cubes dial dependencies growth atlas-files axe cameras examples showcase first-steps looks emission environment measurements

build: $(INSTALLED)
	mkdir -p $(OUT)
	$(BIN)/uplift build --atlas atlases/macbeth.txt --dim 32 --debug -o $(OUT)/macbeth-32.uplift --force
	$(BIN)/uplift slices $(OUT)/macbeth-32.uplift -o $(OUT)/macbeth-32.exr --plot $(OUT)/macbeth-32.png --force
	$(BIN)/uplift query --cube $(OUT)/macbeth-32.uplift '#da7b2a' --plot $(OUT)/orange.png --force

lint: $(INSTALLED)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/codespell
	$(BIN)/python tools/lint.py
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo --cache-dir $(OUT)/cache/import_linter

# One worker per core, at most four as each takes over 1 GB. A worker that crashes ends the run.
test: lint axe
	$(BIN)/pytest --numprocesses auto --maxprocesses 4 --dist loadfile --max-worker-restart 0 --durations 10

# The tests without compilers, browser, node and LLVM, in an empty home folder.
bare: $(INSTALLED)
	rm -rf $(OUT)/bare
	mkdir -p $(OUT)/bare/bin $(OUT)/bare/home
	IFS=:; for folder in $$PATH; do ln -s $$folder/* $(OUT)/bare/bin 2> /dev/null || true; done
	cd $(OUT)/bare/bin && rm -f *cc *++ *gcc-* *g++-* c89* c99* clang* chrom* google-chrome* node* np[mx] cmake glslang*
	PATH=$(abspath $(OUT))/bare/bin HOME=$(abspath $(OUT))/bare/home DRJIT_LIBLLVM_PATH=/nonexistent $(MAKE) test

# The tests with numpy's code for processors without AVX-512.
basic: $(INSTALLED)
	NPY_DISABLE_CPU_FEATURES='X86_V4 AVX512_ICL AVX512_SPR' $(MAKE) test

# What commands answer and write, bit by bit: `make golden-before` on the code before a change, `make golden` after it.
golden: $(INSTALLED)
	$(BIN)/python -m tools.golden $(NAMES)

golden-before: $(INSTALLED)
	$(BIN)/python -m tools.golden record

# Render the pages from the stored measurements in docs/data; nothing is measured.
docs: $(INSTALLED)
	$(BIN)/python -m tools.error_codes
	$(BIN)/python -m tools.render_docs

# The documentation site, out/site/index.html; it runs the notebooks. The tests then look at the pages.
site: $(INSTALLED)
	IPYTHONDIR=$(abspath $(OUT))/cache/ipython $(BIN)/python -m sphinx -W --keep-going -q -b html docs $(OUT)/site
	$(BIN)/pytest -m site tests/test_site.py

# axe-core, the rules of accessibility by which the tests check pages, from a package that contains it. Where it cannot be
# fetched, these tests are skipped.
axe: $(AXE)

$(AXE): $(INSTALLED)
	-$(PIP) --no-deps --upgrade --target $(OUT)/axe axe-playwright-python==0.1.8 && touch $(AXE)

bench: $(INSTALLED)
	$(BIN)/python -m benchmarks.bench
	$(BIN)/python -m benchmarks.programs
	$(BIN)/python -m tools.render_docs performance

# Speed and accuracy of all methods: docs/chart.md, its pictures, and the table of `uplift chart --recommend`.
chart: $(INSTALLED)
	$(BIN)/python -m benchmarks.chart
	$(BIN)/python -m tools.render_docs chart

# Tools for comparison in `make bench` and `make chart`. Ceres comes from the system: libceres-dev, cmake, g++.
peers: $(INSTALLED)
	$(PIP) -c constraints.txt --no-build-isolation -e '.[peers]'

# Orders of growth, starts and solvers: docs/growth.md.
growth: $(INSTALLED)
	$(BIN)/python -m benchmarks.growth
	$(BIN)/python -m tools.render_docs growth

accuracy: $(INSTALLED)
	$(BIN)/python -m benchmarks.accuracy
	$(BIN)/python -m tools.render_docs accuracy

# Measurements behind the design: docs/moments.md and docs/fidelity.md.
study: $(INSTALLED)
	$(BIN)/python -m benchmarks.moments
	$(BIN)/python -m benchmarks.coefficients
	$(BIN)/python -m benchmarks.fidelity
	$(BIN)/python -m tools.render_docs moments fidelity

# The library of the learnt prior, uplift/fit/library.npz, from atlases/ and colour-science.
library: $(INSTALLED)
	$(BIN)/python -m tools.ship_library

# Bounds of colours under other lights: docs/looks.md.
looks: $(INSTALLED)
	$(BIN)/python -m benchmarks.looks
	$(BIN)/python -m tools.render_docs looks

# The learnt prior on materials that it does not know: docs/prior.md.
prior: $(INSTALLED)
	$(BIN)/python -m benchmarks.prior
	$(BIN)/python -m tools.render_docs prior

# Halves of atlases predicted by the other halves, and by plain baselines: docs/held-out.md.
.PHONY: held-out
held-out: $(INSTALLED)
	$(BIN)/python -m benchmarks.held_out
	$(BIN)/python -m tools.render_docs held-out

# Raw values of cameras, by cubes and by matrices: docs/cameras.md.
cameras: $(INSTALLED)
	$(BIN)/python -m benchmarks.cameras
	$(BIN)/python -m tools.render_docs cameras

# Failures and sensitivity: docs/stability.md.
stability: $(INSTALLED)
	$(BIN)/python -m benchmarks.storage
	$(BIN)/python -m benchmarks.stability
	$(BIN)/python -m tools.render_docs stability

# Malformed input, ten thousand of each kind, and a thousand commands of each class: takes minutes.
nightly: $(INSTALLED)
	$(BIN)/python -m tests.fuzz

# Reproducibility across threads and instruction sets: docs/stability.md.
determinism: $(INSTALLED)
	$(BIN)/python -m benchmarks.determinism
	$(BIN)/python -m tools.render_docs stability

# The ColorChecker rendered with Mitsuba: docs/render.md.
demo-render: $(INSTALLED)
	$(BIN)/python -m benchmarks.render
	$(BIN)/python -m benchmarks.render.rates
	$(BIN)/python -m tools.render_docs render

# Emission tables: lamps left out, exactness, expected errors, cost: docs/emission.md and its picture.
emission: $(INSTALLED)
	$(BIN)/python -m benchmarks.emission
	$(BIN)/python -m tools.render_docs emission

# The ColorChecker under environments of measured lamps, rendered with Mitsuba: docs/emission.md.
environment: $(INSTALLED)
	$(BIN)/python -m benchmarks.environment
	$(BIN)/python -m tools.render_docs emission

# Accuracy, speed and memory of textures: docs/textures.md.
textures: pictures
	$(BIN)/python -m benchmarks.textures
	$(BIN)/python -m benchmarks.textures.memory
	$(BIN)/python -m benchmarks.textures.storage
	$(BIN)/python -m tools.render_docs textures

# Gamut mappings: docs/display.md and its picture.
display: $(INSTALLED)
	$(BIN)/python -m benchmarks.display
	$(BIN)/python -m tools.render_docs display

# Mixing models: ramps, criteria, times: docs/mixing.md.
mixing: $(INSTALLED)
	$(BIN)/python -m benchmarks.mixing
	$(BIN)/python -m tools.render_docs mixing

# Cubes restricted to a scene: docs/scenes.md.
scenes: pictures
	$(BIN)/python -m benchmarks.scenes
	$(BIN)/python -m tools.render_docs scenes

# Scene plans for real images, and the accuracy of their predictions: docs/plan.md.
plan: pictures
	$(BIN)/python -m benchmarks.plan
	$(BIN)/python -m tools.render_docs plan

# Frame rate of the relighting viewer in Chromium: docs/palette-dial.md.
dial: $(INSTALLED)
	$(BIN)/python -m benchmarks.dial
	$(BIN)/python -m benchmarks.dial.scan
	$(BIN)/python -m tools.render_docs palette-dial

# Accuracy of the factor model of palettes, and the examples: docs/palette.md and its pictures.
palette: $(INSTALLED)
	$(BIN)/python -m benchmarks.palette
	$(BIN)/python -m tools.render_docs palette

# Cubes with looks, and textures and scenes of several cubes: docs/look-cubes.md and its picture.
look-cubes: $(INSTALLED)
	$(BIN)/python -m benchmarks.look_cubes
	$(BIN)/python -m tools.render_docs look-cubes

# Wavelength selection, and reproduction of Meyer 1988: docs/wavelengths.md.
wavelengths: $(INSTALLED)
	$(BIN)/python -m benchmarks.wavelengths
	$(BIN)/python -m tools.render_docs wavelengths

# Spectral representations, compared with Kment 2011: docs/representations.md.
representations: $(INSTALLED)
	$(BIN)/python -m benchmarks.representations
	$(BIN)/python -m tools.render_docs representations

# Formats of atlas files: docs/atlas-files.md.
atlas-files: $(INSTALLED)
	$(BIN)/python -m benchmarks.atlas_files
	$(BIN)/python -m tools.render_docs atlas-files

# Size and import time of the dependencies: docs/dependencies.md.
dependencies: $(INSTALLED)
	$(BIN)/python -m benchmarks.dependencies
	$(BIN)/python -m tools.render_docs dependencies

# Packages whose example images the benchmarks use.
pictures: $(INSTALLED)
	$(PIP) --no-deps --upgrade --target $(OUT)/pictures scikit-image==0.26.0 scikit-learn==1.9.1

# 1,269 chips of the Munsell book, for `make study`: they cannot be redistributed.
munsell: $(INSTALLED)
	$(PIP) --no-deps --upgrade --target $(OUT)/luxpy luxpy==1.12.5
	$(BIN)/python tools/munsell.py $(OUT)/luxpy $(OUT)/munsell.csv

# Shipped data; commit the result.
atlases: $(INSTALLED)
	$(BIN)/python tools/ship_atlases.py

# Pictures and numbers of the README, and docs/showcase.md. Needs Mitsuba 3.
showcase: $(INSTALLED)
	$(BIN)/python -m benchmarks.showcase
	$(BIN)/python -m tools.render_docs showcase README

# Time from nothing to the first relit picture.
first-steps: $(INSTALLED)
	$(BIN)/python -m benchmarks.first_steps
	$(BIN)/python -m tools.render_docs showcase README

# All measured pages, one after the other, on a quiet machine: hours. Run again, it goes on where it stopped;
# `python -m benchmarks.measurements --minutes 75` starts what can end in time. Before it, `make peers munsell` installs what some steps compare with.
measurements: $(INSTALLED)
	$(BIN)/python -m benchmarks.measurements

# Every example of the README, the documentation and the help, from a wheel: takes about 20 minutes.
examples: $(INSTALLED)
	$(BIN)/python -m tests.examples

# Sample pictures and measurements of `uplift samples`; commit the result.
samples: $(INSTALLED)
	$(BIN)/python -W ignore -m tools.ship_samples

cubes: $(INSTALLED)
	$(BIN)/python tools/store_cubes.py

# Update all pinned versions in constraints.txt.
lock:
	$(PIP) uv
	$(BIN)/uv pip compile --quiet --universal --fork-strategy fewest --python-version 3.11 --upgrade \
	  --all-extras --no-header --no-annotate pyproject.toml -o constraints.txt

$(INSTALLED): pyproject.toml constraints.txt Makefile
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "uplift needs Python 3.11 or later: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)
	$(PIP) pip==26.3
	$(PIP) -c constraints.txt setuptools wheel
	PYTHONWARNINGS=ignore $(PIP) -c constraints.txt --no-build-isolation -e '.[dev]'
	touch $(INSTALLED)

clean:
	rm -rf $(VENV) $(OUT) build dist *.egg-info
