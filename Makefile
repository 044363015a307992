# Two commands do everything on a fresh Debian 12, as root or with sudo: `make demo` and `make test`.
# Presets for daily work (dev, asan-ubsan, tsan) are in CMakePresets.json; see CONTRIBUTING.md.

BUILD := build/release
JOBS ?= $(shell nproc)
# Further settings for CMake, such as -DTYNDALL_WERROR=ON.
CMAKE_FLAGS ?=
# Further arguments for CTest, such as -R Exr or -L unit.
TEST_FLAGS ?=

.DEFAULT_GOAL := help
.PHONY: help setup build programs demo test test-slow validation references package clean

help: ## say what there is to do
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-11s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: ## install the Debian packages that are missing (root or sudo)
	@cmake/install-packages.sh

build: setup ## build everything, optimised, into build/release
	@cmake --preset release $(CMAKE_FLAGS)
	@cmake --build $(BUILD) --parallel $(JOBS)

programs: setup ## build the programs alone, without the tests
	@cmake --preset release $(CMAKE_FLAGS)
	@cmake --build $(BUILD) --parallel $(JOBS) --target tyndall tyndall-grid-reader tyndall-editor

demo: programs ## render the demo scene with indirect light, without a display, to out/demo.png
	@mkdir -p out
	@$(BUILD)/bin/tyndall capture content/demo.scene.json --size 640x360 -o out/demo.png --report out/demo.json
	@echo "The picture is $(CURDIR)/out/demo.png; what it took is in $(CURDIR)/out/demo.json."
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ]; then \
	    echo "To look around in it: $(BUILD)/bin/tyndall-editor content/demo.scene.json"; fi

test: build ## build and run all tests but the slow ones
	@ctest --test-dir $(BUILD) --label-exclude slow --parallel 2 --output-on-failure $(TEST_FLAGS)

test-slow: build ## run the slow tests: every file of the shared content, long sweeps
	@ctest --test-dir $(BUILD) --label-regex slow --parallel 2 --output-on-failure $(TEST_FLAGS)

# The table of known results lies beside the repository, with the shared content. PRECISE=1: for the night, and the next one.
TABLE ?= ../shared/reference/rt-tables.csv
validation: build ## measure the reference against the table of known results, into docs/measured/validation.md
	@$(BUILD)/tests/reference_validation --table $(TABLE) --report docs/measured/validation.md $(if $(PRECISE),--precise)

references: build ## make the reference pictures of the tests that are missing or stale (tests/images/references)
	@tests/images/make_references.py $(BUILD)/bin/tyndall

package: build ## make dist/tyndall-VERSION-linux-x86_64.tar.gz, which runs from any folder
	@cmake/package.sh $(BUILD) dist

clean: ## remove build/release, out and dist
	@rm -rf $(BUILD) out dist
