# SPDX-License-Identifier: MIT
# glim. `make help` lists the targets.

PREFIX ?= /usr/local
BINDIR ?= $(PREFIX)/bin
LIBDIR ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
PKGCONFIGDIR ?= $(LIBDIR)/pkgconfig
MANDIR ?= $(PREFIX)/share/man
DATADIR ?= $(PREFIX)/share/glim
CC ?= cc
CFLAGS ?= -O3 -g
INSTALL ?= install
V ?= 0
Q = $(if $(filter 1,$(V)),,@)
SAY = $(if $(filter 1,$(V)),@:,@printf '  %-5s %s\n')

# Threads and seeds of `make bench-error`.
THREADS ?= 1
ROUNDS ?= 5

# Compiler of `make fuzz`, since only clang has libFuzzer, and seconds for each
# target.
FUZZ_CC ?= clang
TIME ?= 60

# Scene of `make run`.
SCENE ?= scenes/cornell.obj

comma := ,
COMPILER := $(notdir $(firstword $(CC)))
VARIANT := $(if $(SAN),san-$(subst $(comma),-,$(SAN)),release)$(if \
	$(filter clang%,$(COMPILER)),-clang)
B := build/$(VARIANT)

WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes \
	-Wmissing-prototypes -Wpointer-arith -Wcast-qual -Wwrite-strings \
	-Wvla -Wundef -Wformat=2 -Werror=format-security
X86_64 := $(findstring x86_64,$(shell $(CC) -dumpmachine))
# Protection against writes out of bounds. The checks of the C library need the
# optimiser; sanitizers have their own. The program and the library share their
# objects: -fPIC costs no measurable time if only GLIM_API is visible.
HARDENING := -fPIC -fvisibility=hidden -fstack-protector-strong \
	-fstack-clash-protection \
	$(if $(X86_64),-fcf-protection)
FORTIFY = $(if $(SAN),,$(if $(filter-out -O0,$(filter -O%,$(CFLAGS))), \
	-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2))
ALL_CFLAGS = -std=c11 -D_GNU_SOURCE -ffp-contract=off -fno-math-errno \
	-fno-trapping-math -I. -Isrc -Iinclude -pthread $(WARNINGS) $(HARDENING) \
	$(FORTIFY) $(CFLAGS) $(if $(SAN), \
	-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer)
ALL_LDFLAGS = -pthread -pie -Wl,-z,relro,-z,now $(LDFLAGS) \
	$(if $(SAN),-fsanitize=$(SAN))
HASH := \#
# WebP images are read if libwebp is there.
WEBP := $(shell echo '$(HASH)include <webp/decode.h>' | $(CC) -E -x c - \
	>/dev/null 2>&1 && echo 1)
# Meshes of KHR_draco_mesh_compression are read if libdraco is there, and a
# compiler for the one file in C++.
ifeq ($(origin CXX),default)
CXX := $(shell echo '$(CC)' | sed 's/gcc/g++/; s/clang/clang++/; s/\(^\|\/\)cc$$/\1c++/')
endif
DRACO := $(shell printf '%s\n' \
	'$(HASH)if !__has_include(<draco/compression/decode.h>)' '$(HASH)error' \
	'$(HASH)endif' '$(HASH)include <memory>' | \
	$(CXX) -E -x c++ - >/dev/null 2>&1 && echo 1)
# The check of vptr needs the sanitizer's C++ runtime, which a C program lacks.
ALL_CXXFLAGS = -std=c++17 $(filter-out -std=c11 -Wstrict-prototypes \
	-Wmissing-prototypes,$(ALL_CFLAGS)) $(if $(SAN),-fno-sanitize=vptr)
LIB_LIBS = -ljansson -lmeshoptimizer $(if $(WEBP),-lwebp) -lz -lm -ldl
LIBS = -lncursesw -ltinfo $(if $(DRACO),-ldraco -lstdc++) $(LIB_LIBS)
FLAGS = $(if $(DRACO),$(CXX) $(strip $(ALL_CXXFLAGS)) : )$(CC) $(strip $(ALL_CFLAGS)) : $(strip $(ALL_LDFLAGS)) $(LIBS)

KERNELS := $(sort $(wildcard kernels/*.h kernels/*.cl))
# src/render/cpu_kernel.c is built for each instruction set and each set of
# features. cpu_dispatch.c uses the first set that covers the scene: walls and
# lamps, images on them, most materials, those of typical glTF files, each also
# with what the filter needs, all of light, or all features.
ISAS := $(if $(X86_64),avx2 avx512)
FLAGS_avx2 := -mavx2 -mfma -mbmi
FLAGS_avx512 := $(FLAGS_avx2) -mavx512f -mavx512vl -mavx512dq -mavx512bw \
	-mprefer-vector-width=256
SETS := lamps lamps_filter images images_filter shiny shiny_filter gltf \
	gltf_filter light
FEATURES_lamps := FEATURE_EMITTERS
FEATURES_lamps_filter := $(FEATURES_lamps) | FEATURE_FILTER
# gcc 12 loses sight of `is_lit`, which guards the light sample, in one of them.
FLAGS_lamps := -DFLATTEN $(if $(filter clang%,$(COMPILER)),,-Wno-maybe-uninitialized)
FLAGS_lamps_filter := $(FLAGS_lamps)
FEATURES_images := $(FEATURES_lamps) | FEATURE_TEXTURES | FEATURE_COVERAGE | \
	FEATURE_GUIDE
FEATURES_images_filter := $(FEATURES_images) | FEATURE_FILTER
FEATURES_shiny := $(FEATURES_lamps) | FEATURE_TEXTURES | FEATURE_SKY_IMAGE | \
	FEATURE_METAL | FEATURE_GLASS | FEATURE_PLASTIC | FEATURE_ROUGH | \
	FEATURE_DIRECTIONAL_LIGHTS | \
	FEATURE_GUIDE
FEATURES_shiny_filter := $(FEATURES_shiny) | FEATURE_FILTER
FEATURES_gltf := $(FEATURES_images) | FEATURE_TEXTURE_OPTIONS | \
	FEATURE_SKY_IMAGE | FEATURE_DIRECTIONAL_LIGHTS | FEATURE_POINT_LIGHTS | \
	FEATURE_METAL | FEATURE_PLASTIC | FEATURE_ROUGH | FEATURE_ROUGH_DIFFUSE | \
	FEATURE_PRINCIPLED | FEATURE_BUMPS
FEATURES_gltf_filter := $(FEATURES_gltf) | FEATURE_FILTER
FEATURES_light := FEATURES_ALL & ~(FEATURE_AOV | FEATURE_TEXTURE_OPTIONS | \
	FEATURE_INSTANCES | FEATURE_VERTEX_ALPHAS | FEATURE_TANGENTS | \
	FEATURE_COAT_NORMALS)
PATHS := $(patsubst %,$(B)/paths_%.o,$(ISAS) \
	$(foreach isa,plain $(ISAS),$(SETS:%=$(isa)_%)))
# src/filter/filter_loops.c is built for each instruction set.
FILTERS := $(ISAS:%=$(B)/filter_loops_%.o)
# With MPI=1 the program has src/cluster/; otherwise cluster_none.c replaces it.
MPI_SOURCES := $(addprefix src/cluster/,cluster.c cluster_backend.c \
	cluster_pass.c cluster_worker.c wire.c)
WEBP_OTHER := src/picture/$(if $(WEBP),image_webp_none.c,image_webp.c)
DRACO_NONE := src/import/draco_decode_none.c
SOURCES := $(filter-out $(MPI_SOURCES) $(WEBP_OTHER) $(if $(DRACO),$(DRACO_NONE)), \
	$(wildcard src/*.c src/*/*.c))
OBJECTS := $(patsubst src/%.c,$(B)/%.o,$(SOURCES)) $(B)/kernels.o \
	$(if $(DRACO),$(B)/import/draco_decode.o) \
	$(PATHS) $(FILTERS)
PROGRAM := $(B)/$(if $(MPI),mpi/)glim
# Tests of clusters need the program for them, where MPI is installed.
MPI_PROGRAM := $(if $(SAN),,$(if $(shell command -v mpicc),$(B)/mpi/glim))
LIBRARY := $(filter-out $(B)/main.o,$(OBJECTS))
# libglim: the folders up to src/api/ in the table of CONTRIBUTING.md.
LIB_FOLDERS := base picture filter bvh light scene formats gltf import load render opencl api
LIB_OBJECTS := $(patsubst src/%.c,$(B)/%.o,$(filter-out $(WEBP_OTHER) \
	src/import/draco%, \
	$(foreach d,$(LIB_FOLDERS),$(wildcard src/$(d)/*.c)))) $(B)/kernels.o \
	$(PATHS) $(FILTERS)
VERSION := $(shell sed -n 's/.*GLIM_VERSION *"\(.*\)"/\1/p' include/glim/version.h)
SONAME := libglim.so.$(firstword $(subst ., ,$(VERSION)))
LIB_FILES := $(B)/libglim.a $(B)/libglim.so.$(VERSION) $(B)/glim.pc
PUBLIC_HEADERS := $(wildcard include/glim/*.h)
UNITS := $(patsubst tests/unit/%.c,$(B)/unit/%,$(wildcard \
	tests/unit/*/test_*.c))
BENCHES := $(patsubst tests/bench/%.c,$(B)/bench/%,$(wildcard tests/bench/*.c))
STRESSES := $(patsubst tests/stress/%.c,$(B)/stress/%,$(wildcard \
	tests/stress/*.c))
FUZZERS := $(patsubst tests/fuzz/%.c,$(B)/fuzz/%,$(wildcard \
	tests/fuzz/fuzz_*.c))
# libFuzzer has its own main(); without it, replay.c reads inputs from files.
FUZZ_MAIN := $(if $(findstring fuzzer,$(SAN)),-fsanitize=fuzzer,$(B)/fuzz/replay.o)
TOOLS := $(patsubst tests/tools/%.c,$(B)/tools/%,$(wildcard tests/tools/*.c))
ERROR_BENCH := $(patsubst tests/bench/error/%.c,$(B)/error/%.o,$(filter-out \
	%/scenes.c,$(wildcard tests/bench/error/*.c))) $(patsubst \
	%,$(B)/error/paths_%.o,whole hashed uniform throughput shadows)
RAYS_BENCH := $(patsubst tests/bench/rays/%.c,$(B)/rays/%.o,$(filter-out \
	%/scaling.c,$(wildcard tests/bench/rays/*.c))) \
	$(ISAS:%=$(B)/rays/glim_racer_%.o)
GENERATOR := $(patsubst scenes/%.c,$(B)/scenes/%.o,$(wildcard scenes/*.c))
# Uses all cores unless the caller gives -j.
MAKE_ALL = $(MAKE) --no-print-directory \
	$(if $(findstring jobserver,$(MAKEFLAGS)),,-j$$(nproc))
SCENE_FILES = $(foreach e,obj mtl glb view png hdr,$(wildcard scenes/*.$(e)))
C_FILES = $(foreach d,include/glim src src/* kernels scenes tests/unit tests/unit/* \
	tests/bench \
	tests/api tests/bench/error tests/bench/rays tests/fuzz tests/stress tests/tools, \
	$(wildcard $(d)/*.[ch] $(d)/*.cc)) $(wildcard kernels/*.cl)

## all: the program, build/release/glim (the default); with MPI=1 for clusters,
##       build/release/mpi/glim
all: $(PROGRAM)

$(B)/glim: $(OBJECTS) $(B)/flags
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $(OBJECTS) $(LIBS)

$(B)/%.o: src/%.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

define compile_cxx
	@mkdir -p $(@D)
	$(SAY) CXX $<
	$(Q)$(CXX) $(ALL_CXXFLAGS) -MMD -MP -c -o $@ $<
endef
$(B)/import/draco_decode.o: src/import/draco_decode.cc $(B)/flags
	$(compile_cxx)
$(B)/unit/gltf/draco_encode.o: tests/unit/gltf/draco_encode.cc $(B)/flags
	$(compile_cxx)

$(B)/gltf/gltf_draco.o: private ALL_CFLAGS += $(if $(DRACO),-DHAS_DRACO)
$(B)/cluster/wire.o: private ALL_CFLAGS += $(shell mpicc --showme:compile)

$(B)/mpi/glim: $(filter-out %/cluster_none.o,$(OBJECTS)) \
		$(MPI_SOURCES:src/%.c=$(B)/%.o) $(B)/flags
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $(filter %.o,$^) $(LIBS) \
		$(shell mpicc --showme:link)

# The program that tries OpenCL devices and reads formats for the library.
$(B)/api/glim_scene.o: private ALL_CFLAGS += -DGLIM_PROGRAM='"$(BINDIR)/glim"'
$(B)/api/glim_scene.o $(B)/glim.pc: $(B)/places

# $* is the instruction set and, after a _, the set of features.
ISA = $(firstword $(subst _, ,$*))
SET = $(if $(findstring _,$*),$(patsubst $(ISA)_%,%,$*))

$(PATHS): $(B)/paths_%.o: src/render/cpu_kernel.c $(B)/flags
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) $(FLAGS_$(ISA)) $(FLAGS_$(SET)) -DPATHS=paths_$* \
		-DPATHS_NAME='"$(ISA)"' $(if $(SET),-DFEATURES='($(FEATURES_$(SET)))') \
		-MMD -MP -c -o $@ $<

$(FILTERS): $(B)/filter_loops_%.o: src/filter/filter_loops.c $(B)/flags
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) $(FLAGS_$*) -mprefer-vector-width=512 \
		-DLOOPS=filter_loops_$* -MMD -MP -c -o $@ $<

# The time of the folder changes when a file is added or removed.
$(B)/kernels.c: kernels $(KERNELS) kernels/embed.sh $(B)/flags
	$(SAY) EMBED $@
	$(Q)kernels/embed.sh $(KERNELS) > $@.new && mv $@.new $@

$(B)/kernels.o: $(B)/kernels.c
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

$(B)/scenes/%.o: scenes/%.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

$(B)/scenes/generate: $(GENERATOR) $(B)/picture/stb.o
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $(GENERATOR) $(B)/picture/stb.o -lm

define program
$(B)/$(1)/%: tests/$(1)/%.c $(LIBRARY) $(B)/flags
	@mkdir -p $$(@D)
	$$(SAY) CC $$<
	$$(Q)$$(CC) $$(ALL_CFLAGS) -MMD -MP -MF $$@.d $$(ALL_LDFLAGS) -o $$@ $$< \
		$$(LIBRARY) $(2) $$(LIBS)
endef
$(eval $(call program,unit,-lcmocka))
$(foreach i,$(ISAS),$(eval $(B)/unit/bvh/test_bvh8_$(i): \
	private ALL_CFLAGS += $(FLAGS_$(i))))
# test_tty inspects the event loop each time before it waits.
$(B)/unit/terminal/test_tty: private ALL_LDFLAGS += \
	-Wl,--wrap=workspace_next_ns,--wrap=tty_read
# It reads files with OpenEXR's library.
$(B)/unit/picture/test_image_exr: private LIBS += -lOpenEXRCore
# It packs meshes with libdraco.
ifneq ($(DRACO),)
$(B)/unit/gltf/test_gltf_draco: private ALL_CFLAGS += -DHAS_DRACO
$(B)/unit/gltf/test_gltf_draco: private LIBS := $(B)/unit/gltf/draco_encode.o \
	$(LIBS)
$(B)/unit/gltf/test_gltf_draco: $(B)/unit/gltf/draco_encode.o
endif
# It makes the disk slow.
$(B)/unit/session/test_session_film: private ALL_LDFLAGS += -Wl,--wrap=fsync
# It lets allocations fail, and counts what is freed.
WRAPPED := malloc calloc realloc aligned_alloc strdup strndup vasprintf \
	__vasprintf_chk open_memstream getline __getdelim free
$(B)/unit/api/test_out_of_memory: private ALL_LDFLAGS += \
	$(WRAPPED:%=-Wl,--wrap=%)
$(eval $(call program,bench))
$(eval $(call program,fuzz,$(FUZZ_MAIN)))
$(eval $(call program,stress,-lcmocka))
$(eval $(call program,tools))

$(FUZZERS): $(filter %.o,$(FUZZ_MAIN))
$(B)/fuzz/%.o: tests/fuzz/%.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

$(B)/error/%.o: tests/bench/error/%.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

# The CPU kernel with one function replaced, and unchanged, compiled for the
# processor that measures.
$(B)/error/paths_%.o: src/render/cpu_kernel.c tests/bench/error/%.h $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) -march=native -mprefer-vector-width=256 \
		-DPATHS=paths_$* -DPATHS_NAME='"$*"' \
		-include tests/bench/error/$*.h -MMD -MP -c -o $@ $<

$(B)/error/error: $(ERROR_BENCH) $(LIBRARY)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

$(B)/error/scenes: $(B)/error/scenes.o $(B)/scenes/mesh.o \
	$(foreach i,file temp_file error memory cgroup_quota clock print,$(B)/base/$(i).o) \
	$(B)/terminal/xmalloc.o
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

$(B)/rays/%.o: tests/bench/rays/%.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC $<
	$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<

$(ISAS:%=$(B)/rays/glim_racer_%.o): $(B)/rays/glim_racer_%.o: \
		tests/bench/rays/glim_racer.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) $(FLAGS_$*) -DRACER=racer_$* -MMD -MP -c -o $@ $<

$(B)/rays/rays: $(RAYS_BENCH) $(LIBRARY)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ -lembree3 $(LIBS)

$(B)/rays/scaling: $(B)/rays/scaling.o $(filter-out %/rays.o %/embree_racer.o, \
		$(RAYS_BENCH)) $(LIBRARY)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

# A change of flags or compiler rebuilds this variant.
$(B)/flags: FORCE
	@mkdir -p $(@D)
	@command -v $(firstword $(CC)) >/dev/null || \
		{ echo "no compiler '$(firstword $(CC))': try 'make deps'"; exit 1; }
	@echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@

## lib: libglim, the renderer for other programs, build/release/libglim.a and
##      libglim.so
lib: $(LIB_FILES) $(B)/libglim.so

# One object, in which only the functions of glim.h are visible.
$(B)/libglim.o: $(LIB_OBJECTS) $(B)/flags
	$(SAY) LINK $@
	$(Q)$(CC) -r -nostdlib -o $@ $(LIB_OBJECTS)
	$(Q)objcopy --localize-hidden $@

$(B)/libglim.a: $(B)/libglim.o
	$(SAY) AR $@
	$(Q)rm -f $@ && $(AR) rcs $@ $<

$(B)/libglim.so.$(VERSION): $(LIB_OBJECTS) $(B)/flags
	$(SAY) LINK $@
	$(Q)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,-z,defs \
		$(filter-out -pie,$(ALL_LDFLAGS)) -o $@ $(LIB_OBJECTS) $(LIB_LIBS)

$(B)/libglim.so: $(B)/libglim.so.$(VERSION)
	$(Q)ln -sf $(<F) $(B)/$(SONAME) && ln -sf $(<F) $@

$(B)/glim.pc: include/glim/version.h Makefile
	$(Q)printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' \
		'includedir=$(INCLUDEDIR)' '' 'Name: glim' \
		'Description: path tracer for OBJ scenes' 'Version: $(VERSION)' \
		'Libs: -L$${libdir} -lglim' 'Libs.private: -pthread $(LIB_LIBS)' \
		'Cflags: -I$${includedir}' > $@

# Other places to install to rebuild what knows them.
$(B)/places: FORCE
	@mkdir -p $(@D)
	@echo '$(PREFIX) $(BINDIR) $(LIBDIR) $(INCLUDEDIR)' | cmp -s - $@ || \
		echo '$(PREFIX) $(BINDIR) $(LIBDIR) $(INCLUDEDIR)' > $@

## run: installs missing packages, builds, opens SCENE (the Cornell box);
##      without a terminal it renders to a file
run:
	@CC='$(CC)' tests/tools/deps.sh build
	@+$(MAKE_ALL) $(B)/glim $(B)/tools/show
	@if [ -t 0 ] && [ -t 1 ]; then \
		$(B)/glim $(SCENE); \
	else \
		$(B)/glim -b -h 400 -s 64 -o build/run.png $(SCENE) && \
		$(B)/tools/show build/run.png && echo 'picture: build/run.png'; \
	fi

## test: installs missing packages, builds, runs all tests; FILTER=PART of
##       their names; SAN=address,undefined or SAN=thread for sanitizers
test:
	@CC='$(CC)' tests/tools/deps.sh build test
	@+$(MAKE_ALL) tests
	@BUILD=$(B) SAN='$(SAN)' CC='$(CC)' tests/run.sh

tests: $(B)/glim $(MPI_PROGRAM) lib $(UNITS) $(TOOLS) $(B)/scenes/generate $(BENCHES) $(STRESSES) \
	$(FUZZERS) $(B)/error/error

## fuzz: tests parsers of files, options and keys with random inputs;
##       TIME=60 seconds for each target, FILTER=PART of a target's name
fuzz:
	@CC='$(FUZZ_CC)' tests/tools/deps.sh build fuzz
	@+$(MAKE_ALL) CC='$(FUZZ_CC)' SAN=fuzzer-no-link,address,undefined \
		CFLAGS='$(if $(filter file,$(origin CFLAGS)),-O1 -g,$(CFLAGS))' search

search: $(FUZZERS)
	@BUILD=$(B) TIME='$(TIME)' FILTER='$(FILTER)' tests/fuzz/search.sh

## bench: measures speed, halting and threads; FILTER=NAME selects one
bench: $(B)/glim $(BENCHES) $(B)/rays/scaling
	@BUILD=$(B) FILTER='$(FILTER)' tests/bench/run.sh

## bench-mpi: measures one and two ranks of a cluster, if Open MPI is installed;
##            ROUNDS=3
bench-mpi: $(B)/mpi/glim
	@ROUNDS=$(if $(filter file,$(origin ROUNDS)),3,$(ROUNDS)) \
		tests/bench/mpi.sh $<

## bench-error: measures error against time, each technique on and off; text,
##              CSV and diagrams in build/bench-error/; FILTER=PART of the
##              scenes' names, THREADS=1 ROUNDS=5 (seeds)
bench-error: $(B)/error/error build/bench-error/scenes
	@mkdir -p build/bench-error/reference
	@{ $< build/bench-error '$(THREADS)' '$(ROUNDS)' '$(FILTER)'; \
		echo $$? > build/bench-error/status; } | \
		tee build/bench-error/report.txt; exit $$(cat build/bench-error/status)

## bench-rays: compares rays per second with Embree 3 (libembree-dev);
##             FILTER=PART of the meshes' names, ISA=avx2
bench-rays:
	@echo '#include <embree3/rtcore.h>' | $(CC) -E -x c - >/dev/null 2>&1 || \
		{ echo 'bench-rays: needs Embree 3: install libembree-dev'; exit 1; }
	@+$(MAKE_ALL) $(B)/rays/rays
	@$(B)/rays/rays "$${GLIM_SHARED:-../shared}" '$(FILTER)' '$(ISA)'

## results: measures the figures of docs/results.md and makes its tables and
##          diagrams; FILTER=SECTION selects one, FILTER=none only draws
results: $(B)/glim $(BENCHES) $(STRESSES) $(B)/rays/scaling \
		build/bench-error/scenes
	@BUILD=$(B) FILTER='$(FILTER)' tests/bench/results/measure.sh
	@BUILD=$(B) tests/bench/results/draw.sh

build/bench-error/scenes: $(B)/error/scenes
	@mkdir -p $@
	$(Q)$< $@ && touch $@

## bench-cycles: compares paths per second with Blender's Cycles, if Debian's
##               blender is installed; FILTER=SCENE, ROUNDS=3
bench-cycles: $(B)/glim
	@BUILD=$(B) FILTER='$(FILTER)' ROUNDS=$(if $(filter file,$(origin \
		ROUNDS)),3,$(ROUNDS)) tests/bench/cycles/run.sh

## stress: runs checks at numerical limits, and others that take minutes;
##         FILTER=NAME selects one: samples geometry light films schedulers
##         error filter gltf blender extremes sizes keys rays oclgrind valgrind
stress: $(B)/glim $(MPI_PROGRAM) $(STRESSES) $(B)/unit/terminal/test_tty
	@BUILD=$(B) FILTER='$(FILTER)' tests/stress/run.sh

## mutants: breaks one factor after another, which a test must notice;
##          FILTER=PART of names, files or tests
mutants:
	@CC='$(CC)' FILTER='$(FILTER)' tests/mutants/run.sh

## scenes: generates the scenes in scenes/
scenes: $(B)/scenes/generate
	$(Q)$(B)/scenes/generate scenes

## tables: computes kernels/energy_tables.h
tables: $(B)/tools/energy
	$(Q)$(B)/tools/energy > $(B)/energy_tables.h
	$(Q)mv $(B)/energy_tables.h kernels/energy_tables.h

## gallery: renders the README's pictures into scenes/gallery/
gallery: $(B)/glim
	@BUILD=$(B) scenes/gallery/render.sh

## screens: takes the pictures of docs/screens.md in a real xterm
screens: $(B)/glim
	@GLIM=$(B)/glim tests/tools/screens.sh

## install: installs program, library, man pages and scenes; DESTDIR PREFIX
##          BINDIR LIBDIR INCLUDEDIR PKGCONFIGDIR MANDIR DATADIR
install: $(PROGRAM) lib
	$(INSTALL) -d '$(DESTDIR)$(BINDIR)' '$(DESTDIR)$(LIBDIR)' \
		'$(DESTDIR)$(INCLUDEDIR)/glim' '$(DESTDIR)$(PKGCONFIGDIR)' \
		'$(DESTDIR)$(MANDIR)/man1' '$(DESTDIR)$(MANDIR)/man3' \
		'$(DESTDIR)$(DATADIR)/scenes'
	$(INSTALL) -m 644 $(B)/libglim.a '$(DESTDIR)$(LIBDIR)'
	$(INSTALL) -m 755 $(B)/libglim.so.$(VERSION) '$(DESTDIR)$(LIBDIR)'
	ln -sf libglim.so.$(VERSION) '$(DESTDIR)$(LIBDIR)/$(SONAME)'
	ln -sf $(SONAME) '$(DESTDIR)$(LIBDIR)/libglim.so'
	$(INSTALL) -m 644 $(PUBLIC_HEADERS) '$(DESTDIR)$(INCLUDEDIR)/glim'
	$(INSTALL) -m 644 $(B)/glim.pc '$(DESTDIR)$(PKGCONFIGDIR)'
	$(INSTALL) -m 644 man/libglim.3 '$(DESTDIR)$(MANDIR)/man3'
	$(INSTALL) -m 755 $(PROGRAM) '$(DESTDIR)$(BINDIR)/glim'
	$(INSTALL) -m 644 man/glim.1 '$(DESTDIR)$(MANDIR)/man1/glim.1'
	$(INSTALL) -m 644 $(SCENE_FILES) '$(DESTDIR)$(DATADIR)/scenes'

## uninstall: removes installed files
uninstall:
	rm -f '$(DESTDIR)$(BINDIR)/glim' '$(DESTDIR)$(MANDIR)/man1/glim.1' \
		'$(DESTDIR)$(MANDIR)/man3/libglim.3' '$(DESTDIR)$(PKGCONFIGDIR)/glim.pc' \
		$(patsubst %,'$(DESTDIR)$(LIBDIR)/%',libglim.a libglim.so $(SONAME) \
		libglim.so.$(VERSION)) \
		$(patsubst include/%,'$(DESTDIR)$(INCLUDEDIR)/%',$(PUBLIC_HEADERS))
	-rmdir '$(DESTDIR)$(INCLUDEDIR)/glim'
	rm -f $(patsubst %,'$(DESTDIR)$(DATADIR)/%',$(SCENE_FILES))
	-rmdir '$(DESTDIR)$(DATADIR)/scenes' '$(DESTDIR)$(DATADIR)'

## deps: lists packages missing for build and tests, and installs them
deps:
	@CC='$(CC)' tests/tools/deps.sh -v build test $(if $(MPI),mpi)

## format: formats the code with clang-format
format:
	@tests/tools/deps.sh lint
	clang-format -i $(C_FILES)

## lint: checks layers, layout, cppcheck, clang-tidy, kernels as OpenCL, manual
lint: $(B)/lint/kernels/energy_tables.h
	@tests/tools/deps.sh build test lint
	tests/layers.sh
	clang-format --dry-run -Werror $(C_FILES)
	cppcheck --quiet --std=c11 --error-exitcode=1 --inline-suppr -j$$(nproc) \
		--enable=warning,portability $(CPPCHECK_OFF) -I$(B)/lint -I. -Isrc \
		-Iinclude src
	printf '%s\n' $(SOURCES) | xargs -n8 -P$$(nproc) sh -c 'clang-tidy --quiet \
		--warnings-as-errors="*" --checks="$(TIDY)" "$$@" -- $(ALL_CFLAGS)' sh
	$(if $(filter %.cl,$(KERNELS)),! command -v clang >/dev/null || \
		clang $(CL_FLAGS) $(filter %.cl,$(KERNELS)))
	mandoc -T lint -W warning man/glim.1 man/libglim.3

# The tables without their numbers, which cppcheck would follow for two seconds
# in each file and each configuration.
$(B)/lint/kernels/energy_tables.h: kernels/energy_tables.h
	@mkdir -p $(@D)
	$(Q)sed '/^ *-*[0-9]/d' $< >$@

# Compiles the kernels for a generic OpenCL device.
CL_FLAGS := -target spir64 -x cl -cl-std=CL1.2 \
	-Xclang -finclude-default-header -fsyntax-only -I. \
	-Wall -Wextra -Wdouble-promotion -Werror
# False reports: errors that are set before they are read, and stacks.
CPPCHECK_OFF := --suppress=missingIncludeSystem --suppress=uninitvar \
	--suppress=ctuuninitvar --suppress=duplicateAssignExpression
# Checks with false reports: the analyzer's core does not know that fail()
# returns false, and OpenCL handles are pointers, so sizeof *array is right.
TIDY := -*,clang-analyzer-*,-clang-analyzer-core.*,$\
	-clang-analyzer-valist.Uninitialized,$\
	-clang-analyzer-security.insecureAPI.Deprecated*,$\
	bugprone-*,-bugprone-branch-clone,$\
	-bugprone-easily-swappable-parameters,$\
	-bugprone-implicit-widening-of-multiplication-result,$\
	-bugprone-narrowing-conversions,-bugprone-not-null-terminated-result,$\
	-bugprone-reserved-identifier,-bugprone-sizeof-expression,$\
	-bugprone-suspicious-memory-comparison

## clean: removes build/
clean:
	rm -rf build

## help: prints this list
help:
	@sed -n 's/^## //p' Makefile
	@echo 'variables: CC CFLAGS LDFLAGS SAN=address,undefined V=1 SCENE=FILE'

.PHONY: all lib run test tests fuzz search bench bench-mpi bench-error bench-rays \
	bench-cycles results stress mutants scenes tables gallery screens install \
	uninstall deps format lint clean help FORCE
-include $(OBJECTS:.o=.d) $(MPI_SOURCES:src/%.c=$(B)/%.d) $(GENERATOR:.o=.d) $(UNITS:=.d) $(BENCHES:=.d) \
	$(STRESSES:=.d) $(FUZZERS:=.d) $(B)/fuzz/replay.d $(TOOLS:=.d) \
	$(ERROR_BENCH:.o=.d) $(RAYS_BENCH:.o=.d) $(B)/rays/scaling.d \
	$(B)/error/scenes.d
