# Two commands: `make demo` and `make test`. Both start with what they need, on a fresh Debian 12 machine too.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help demo test setup configure build clean jobs
.NOTPARALLEL:

# A compiler at work on one file may want 1.5 GB.
JOBS ?= $(shell awk -v cores=$$(nproc) '/^MemAvailable/ { jobs = int($$2 / 1572864) } \
  END { if (jobs > cores) jobs = cores; print jobs < 1 ? 1 : jobs }' /proc/meminfo)

# `make demo` needs no test packages, so it configures without tests, unless build/release has them from `make test` already.
TESTS = $(if $(wildcard build/release/tests/CTestTestfile.cmake),ON,OFF)

# In a new build folder, the sources of a folder are compiled as one unit (cmake/mansard_quick_build.cmake). One that was
# configured before keeps what was chosen.
UNITY = $(if $(wildcard build/release/CMakeCache.txt),,-DMANSARD_UNITY=ON)

help:
	@echo "make demo    reconstruct the samples of data/ into out/"
	@echo "make test    run all tests"
	@echo "make setup   install the packages that both need and this machine lacks"
	@echo "make build   build everything into build/release (JOBS=$(JOBS))"
	@echo "make clean   remove build/release and out"

demo:
	@tools/setup.sh build
	@cmake --preset release -DMANSARD_TESTS=$(TESTS) $(UNITY) --log-level=WARNING > /dev/null
	cmake --build --preset release --target mansard -j $(JOBS)
	@tools/demo.sh

test: build
	ctest --preset release --no-tests=error -j 2

setup:
	@tools/setup.sh build test package

configure: setup
	@cmake --preset release $(UNITY) --log-level=WARNING > /dev/null

build: configure
	cmake --build --preset release -j $(JOBS)

jobs:
	@echo $(JOBS)

clean:
	rm -rf build/release out
