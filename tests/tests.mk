# SPDX-License-Identifier: MIT
# tests.mk - unit tests, fuzz targets, stress programs, and other checks

# Compiler of `make fuzz`, since only clang has libFuzzer, and seconds or runs for
# each target.
FUZZ_CC ?= clang
TIME ?= 60
RUNS ?=

C_FILES = $(foreach d,include/glim src src/* src/*/* kernels scenes tests/unit tests/unit/* \
	tests/bench tests/api tests/bench/error tests/bench/rays tests/fuzz \
	tests/stress tests/tools tests/faults,$(wildcard $(d)/*.[ch] $(d)/*.cc)) \
	$(wildcard kernels/*.cl)
names_of = $(patsubst tests/%.c,$(L)/%,$(wildcard tests/$(1).c))
UNITS := $(call names_of,unit/*/test_*)
FUZZERS := $(call names_of,fuzz/fuzz_*)
STRESSES := $(call names_of,stress/*)
BENCHES := $(call names_of,bench/*)
TOOLS := $(call names_of,tools/*)

# Programs take the objects that they use from a thin archive. Tests are compiled
# quickly and run for a moment; what measures is optimised as glim is.
$(L)/objects.a: $(OBJECTS) $(B)/unit/paths.o
	@mkdir -p $(@D)
	$(SAY) AR $@
	$(Q)rm -f $@ && $(AR) rcsT $@ $^

define program
$(B)/$(1)/%.o: tests/$(1)/%.c $(B)/flags
	$$(compile)
$(L)/$(1)/%: $(B)/$(1)/%.o $(L)/objects.a
	@mkdir -p $$(@D)
	$$(Q)$$(CC) $$(ALL_LDFLAGS) -o $$@ $$< $(2) $(L)/objects.a $$(LIBS)
endef
$(eval $(call program,unit,-lcmocka))
$(eval $(call program,fuzz,$$(FUZZ_MAIN)))
$(eval $(call program,stress,-lcmocka))
$(eval $(call program,bench))
$(eval $(call program,tools))
.SECONDARY:
$(B)/unit/%.o $(B)/fuzz/%.o: private ALL_CFLAGS := \
	$(patsubst -O3,-O1 $(NO_MAYBE),$(ALL_CFLAGS))

# Comparisons in loops over rays and voxels teach libFuzzer nothing and take half
# of the time.
ifneq ($(findstring fuzzer,$(SAN)),)
$(PATHS) $(B)/fuzz/%.o $(B)/world/%.o $(B)/film/%.o $(B)/scene/%.o: \
	private ALL_CFLAGS += -fno-sanitize-coverage=trace-cmp
endif
# Paths for tests, as fast as on the CPU
$(B)/unit/paths.o: private ALL_CFLAGS += -O3 $(FLAGS_$(HOST_ISA))
# Tests with flags of their own.
$(foreach i,$(ISAS),$(eval $(B)/unit/bvh/test_bvh8_$(i).o: \
	private ALL_CFLAGS += $(FLAGS_$(i))))
# test_tty inspects the event loop each time before it waits.
$(L)/unit/terminal/test_tty: private ALL_LDFLAGS += \
	-Wl,--wrap=workspace_next_ns,--wrap=tty_read
# It packs meshes with libdraco.
ifneq ($(DRACO),)
$(B)/unit/gltf/test_gltf_draco.o: private ALL_CFLAGS += -DHAS_DRACO
$(L)/unit/gltf/test_gltf_draco: private LIBS := $(B)/unit/gltf/draco_encode.o \
	$(LIBS)
$(L)/unit/gltf/test_gltf_draco: $(B)/unit/gltf/draco_encode.o
$(B)/unit/gltf/draco_encode.o: tests/unit/gltf/draco_encode.cc $(B)/flags
	$(compile_cxx)
endif
# It lets the clock jump.
$(L)/unit/studio/test_autosave: private ALL_LDFLAGS += -Wl,--wrap=clock_ns
# It makes the clocks fast.
$(L)/unit/opencl/test_cl_thread: private ALL_LDFLAGS += \
	-Wl,--wrap=clock_ns -Wl,--wrap=clock_cpu_ns
# It makes the disk slow.
$(L)/unit/session/test_session_film: private ALL_LDFLAGS += -Wl,--wrap=fsync
# It lets allocations fail.
$(L)/unit/base/test_text_stream: private ALL_LDFLAGS += -Wl,--wrap=realloc
# It lets allocations fail, counts what is freed, and does not wait for disks.
WRAPPED := malloc calloc realloc aligned_alloc strdup strndup vasprintf \
	__vasprintf_chk getline __getdelim realpath free fsync
$(L)/unit/api/test_out_of_memory: private ALL_LDFLAGS += \
	$(WRAPPED:%=-Wl,--wrap=%)

# libFuzzer has its own main(); without it, replay.c reads inputs from files.
FUZZ_MAIN := $(if $(findstring fuzzer,$(SAN)),-fsanitize=fuzzer,$(B)/fuzz/replay.o)
$(FUZZERS): $(filter %.o,$(FUZZ_MAIN))

# Libraries that let calls of glim and of OpenCL fail.
FAULTS := $(if $(SAN),,$(L)/faults/fault.so $(L)/faults/opencl/libOpenCL.so.1)
$(L)/faults/opencl/libOpenCL.so.1: tests/faults/opencl_fault.c
	@mkdir -p $(@D)
	$(SAY) CC $@
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE -O1 -Wall -Wextra -fPIC -shared -o $@ $<
$(L)/faults/fault.so: tests/faults/fault.c
	@mkdir -p $(@D)
	$(SAY) CC $@
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE -O1 -Wall -Wextra -fPIC -shared -o $@ $<

GENERATOR := $(patsubst scenes/%.c,$(B)/scenes/%.o,$(wildcard scenes/*.c))
$(B)/scenes/%.o: scenes/%.c $(B)/flags
	$(compile)
$(L)/scenes/generate: $(GENERATOR) $(B)/image/stb.o
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ -lm

# Tests of clusters need the program for them, where MPI is installed.
MPI_PROGRAM := $(if $(SAN),,$(if $(shell command -v mpicc),$(L)/mpi/glim))
TESTED := $(L)/glim $(MPI_PROGRAM) $(UNITS) $(FUZZERS) $(L)/tools/show \
	$(L)/scenes/generate $(FAULTS)

## test: installs missing packages, builds, runs all tests, with a few builds of
##       the kernel; BUILDS=all has all builds, and compiles benchmarks too;
##       FILTER=PART of their names; SAN=address,undefined or SAN=thread for
##       sanitizers
test: private BUILDS := $(if $(filter command%,$(origin BUILDS)),$(BUILDS),few)
test:
	@CC='$(CC)' tests/tools/deps.sh build test
	@+$(MAKE_ALL) BUILDS=$(BUILDS) tests
	@+$(MAKE_ALL) BUILDS=$(BUILDS) run-tests
tests: $(TESTED) lib $(if $(filter all,$(BUILDS)),$(BENCHES) $(STRESSES) $(TOOLS) \
	$(B)/error/error)
run-tests:
	@BUILD=$(L) BUILDS=$(BUILDS) SAN='$(SAN)' CC='$(CC)' tests/run.sh

## fuzz: tests parsers of files, options and keys, and whole renders, with random
##       inputs; TIME=60 seconds or RUNS=N inputs for each target, FILTER=PART of
##       a target's name; BUILDS=all has all builds of the kernel
fuzz: private BUILDS := $(if $(filter command%,$(origin BUILDS)),$(BUILDS),few)
fuzz:
	@CC='$(FUZZ_CC)' tests/tools/deps.sh build fuzz
	@+$(MAKE_ALL) CC='$(FUZZ_CC)' SAN=fuzzer-no-link,address,undefined \
		BUILDS=$(BUILDS) \
		CFLAGS='$(if $(filter file,$(origin CFLAGS)),-O1 -g,$(CFLAGS))' search
search: $(FUZZERS)
	@BUILD=$(L) RUNS='$(RUNS)' FILTER='$(FILTER)' \
		TIME='$(if $(and $(RUNS),$(filter file,$(origin TIME))),,$(TIME))' \
		tests/fuzz/search.sh

## stress: runs checks at numerical limits, and others that take minutes;
##         FILTER=NAME selects one: samples geometry light films schedulers
##         error filter gltf blender extremes sizes keys rays faults oclgrind
##         valgrind
stress: $(L)/glim $(MPI_PROGRAM) $(FAULTS) $(STRESSES) $(UNITS)
	@BUILD=$(L) FILTER='$(FILTER)' tests/stress/run.sh

## check-sanitizers: runs all tests with address and undefined sanitizers, then
##                   with that for threads, then unit tests under valgrind
check-sanitizers:
	@+status=0; \
	$(MAKE_ALL) SAN=address,undefined test || status=1; \
	$(MAKE_ALL) SAN=thread test || status=1; \
	$(MAKE_ALL) BUILDS=few FILTER=valgrind stress || status=1; exit $$status

## soak: presses random keys for an hour, or TIME=SECONDS: the screen must be the
##       expected one after each, and memory must not grow
soak: $(L)/unit/terminal/test_tty
	@TERM_SECONDS='$(if $(filter file,$(origin TIME)),3600,$(TIME))' \
		TERM_SEED="$$(date +%s)" $<

## mutants: breaks one factor after another, which a test must notice;
##          FILTER=PART of names, files or tests
mutants:
	@CC='$(CC)' FILTER='$(FILTER)' tests/mutants/run.sh

## scenes: generates the scenes in scenes/
scenes: $(L)/scenes/generate
	$(Q)$< scenes

## tables: computes kernels/energy_tables.h and kernels/response_tables.h
tables: $(L)/tools/energy $(L)/tools/response
	$(Q)for name in energy response; do \
		$(L)/tools/$$name > $(B)/tables.h && \
		mv $(B)/tables.h kernels/$${name}_tables.h || exit 1; done

## format: formats the code with clang-format
format:
	@tests/tools/deps.sh lint
	clang-format -i $(C_FILES)

## lint: checks layers, layout, cppcheck, clang-tidy, kernels as OpenCL, manual
lint:
	@tests/tools/deps.sh build test lint
	@printf '%s\n' $(C_FILES) | SOURCES='$(SOURCES) $(KERNEL_SOURCES)' \
		FLAGS='$(ALL_CFLAGS)' BUILD='$(B)' tests/lint.sh

.PHONY: test tests run-tests check-sanitizers fuzz search stress soak mutants scenes tables format lint
-include $(GENERATOR:.o=.d) $(B)/fuzz/replay.d $(B)/unit/paths.d \
	$(B)/unit/gltf/draco_encode.d $(patsubst $(L)/%,$(B)/%.d,$(UNITS) \
	$(STRESSES) $(FUZZERS) $(BENCHES) $(TOOLS))
