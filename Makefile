# SPDX-License-Identifier: MIT
# glim. `make help` lists the targets. kernels.mk has the builds of the kernels,
# tests/tests.mk tests and checks, tests/bench/bench.mk measurements.

PREFIX ?= /usr/local
BINDIR ?= $(PREFIX)/bin
LIBDIR ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
PKGCONFIGDIR ?= $(LIBDIR)/pkgconfig
MANDIR ?= $(PREFIX)/share/man
DATADIR ?= $(PREFIX)/share/glim
CC ?= cc
CFLAGS ?= -O3 -g1
INSTALL ?= install
V ?= 0
Q = $(if $(filter 1,$(V)),,@)
SAY = $(if $(filter 1,$(V)),@:,@printf '  %-5s %s\n')

# Scene of `make run`, and which builds of the kernel a program has: all or few.
SCENE ?= scenes/cornell.obj
BUILDS ?= all

# Objects are in $(B), what is linked from them in $(L).
comma := ,
COMPILER := $(notdir $(firstword $(CC)))
VARIANT := $(if $(SAN),san-$(subst $(comma),-,$(SAN)),release)$(if \
	$(filter clang%,$(COMPILER)),-clang)
B := build/$(VARIANT)
L := $(B)$(if $(filter few,$(BUILDS)),/few)

WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes \
	-Wmissing-prototypes -Wpointer-arith -Wcast-qual -Wwrite-strings \
	-Wvla -Wundef -Wformat=2 -Werror=format-security
# Switches off a warning that gcc gives falsely where it sees too little.
NO_MAYBE := $(if $(filter clang%,$(COMPILER)),,-Wno-maybe-uninitialized)
X86_64 := $(findstring x86_64,$(shell $(CC) -dumpmachine 2>/dev/null))
# Protection against writes out of bounds. The checks of the C library need the
# optimiser; sanitizers have their own. The program and the library share their
# objects: -fPIC costs no measurable time if only GLIM_API is visible.
HARDENING := -fPIC -fvisibility=hidden -fstack-protector-strong \
	-fstack-clash-protection $(if $(X86_64),-fcf-protection)
FORTIFY = $(if $(SAN),,$(if $(filter-out -O0,$(filter -O%,$(CFLAGS))), \
	-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2))
# clang's sanitizer builds fill variables with a pattern; that of gcc 12 gives
# other pictures of instances, where clang and valgrind find no fault.
ALL_CFLAGS = -std=c11 -D_GNU_SOURCE -ffp-contract=off -fno-math-errno \
	-fno-trapping-math -I. -Isrc -Iinclude -pthread $(WARNINGS) $(HARDENING) \
	$(FORTIFY) $(CFLAGS) $(if $(SAN), \
	-fsanitize=$(SAN) -fno-sanitize-recover=all -fno-omit-frame-pointer \
	$(if $(findstring clang,$(CC)),-ftrivial-auto-var-init=pattern))
ALL_LDFLAGS = -pthread -pie -Wl,-z,relro,-z,now $(LDFLAGS) \
	$(if $(SAN),-fsanitize=$(SAN))

# WebP and OpenEXR images are read if their libraries are there; meshes of
# KHR_draco_mesh_compression if libdraco is there, and a compiler for the one file
# in C++.
HASH := \#
has_header = $(shell echo '$(HASH)include <$(1)>' | $(CC) -E -x c - \
	>/dev/null 2>&1 && echo 1)
WEBP := $(call has_header,webp/decode.h)
EXR := $(call has_header,OpenEXR/openexr.h)
ifeq ($(origin CXX),default)
CXX := $(shell echo '$(CC)' | sed 's/gcc/g++/; s/clang/clang++/; s/\(^\|\/\)cc$$/\1c++/')
endif
DRACO := $(shell printf '%s\n' '$(HASH)include <draco/compression/decode.h>' | \
	$(CXX) -std=c++17 -E -x c++ - >/dev/null 2>&1 && echo 1)
# The check of vptr needs the sanitizer's C++ runtime, which a C program lacks.
ALL_CXXFLAGS = -std=c++17 $(filter-out -std=c11 -Wstrict-prototypes \
	-Wmissing-prototypes,$(ALL_CFLAGS)) $(if $(SAN),-fno-sanitize=vptr)
LIB_LIBS = -ljansson -lmeshoptimizer $(if $(WEBP),-lwebp) \
	$(if $(EXR),-lOpenEXRCore) -lz -lm -ldl
LIBS = -lncursesw -ltinfo $(if $(DRACO),-ldraco -lstdc++) $(LIB_LIBS)
FLAGS = $(if $(DRACO),$(CXX) $(strip $(ALL_CXXFLAGS)) : )$(CC) $(strip $(ALL_CFLAGS)) : $(strip $(ALL_LDFLAGS)) $(LIBS)

## all: the program, build/release/glim (the default); with MPI=1 for clusters,
##       build/release/mpi/glim
all: $(L)/$(if $(MPI),mpi/)glim

include kernels.mk

# With MPI=1 the program has src/render/cluster/; otherwise cluster_none.c
# replaces it.
MPI_SOURCES := $(addprefix src/render/cluster/,cluster.c cluster_backend.c \
	cluster_worker.c wire.c)
# kernels.mk compiles these, each several times.
KERNEL_SOURCES := src/render/cpu_kernel.c src/render/cpu_dispatch.c
SOURCES := $(filter-out $(MPI_SOURCES) $(KERNEL_SOURCES) \
	src/image/$(if $(WEBP),image_webp_none.c,image_webp.c) \
	src/image/$(if $(EXR),image_exr_read_none.c,image_exr_read.c) \
	$(if $(DRACO),src/read/child/draco_decode_none.c), \
	$(wildcard src/*.c src/*/*.c src/*/*/*.c))
OBJECTS := $(SOURCES:src/%.c=$(B)/%.o) $(if $(DRACO),$(B)/read/child/draco_decode.o) \
	$(KERNEL_OBJECTS)
# libglim: the folders up to src/api/ in the table of CONTRIBUTING.md.
LIB_FOLDERS := base image film world scene read render engine api
LIB_OBJECTS := $(filter-out $(B)/read/child/draco%,$(sort $(KERNEL_OBJECTS) \
	$(filter $(LIB_FOLDERS:%=$(B)/%/%),$(OBJECTS))))
VERSION := $(shell sed -n 's/.*GLIM_VERSION *"\(.*\)"/\1/p' include/glim/version.h)
SONAME := libglim.so.$(firstword $(subst ., ,$(VERSION)))
# Uses all cores unless the caller gives -j.
MAKE_ALL = $(MAKE) --no-print-directory \
	$(if $(findstring jobserver,$(MAKEFLAGS)),,-j$$(nproc))

$(L)/glim: $(OBJECTS) $(B)/flags
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $(OBJECTS) $(LIBS)

$(L)/mpi/glim: $(filter-out %/cluster_none.o,$(OBJECTS)) \
		$(MPI_SOURCES:src/%.c=$(B)/%.o) $(B)/flags
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $(filter %.o,$^) $(LIBS) \
		$(shell mpicc --showme:link)

define compile
@mkdir -p $(@D)
$(SAY) CC $<
$(Q)$(CC) $(ALL_CFLAGS) -MMD -MP -c -o $@ $<
endef
define compile_cxx
@mkdir -p $(@D)
$(SAY) CXX $<
$(Q)$(CXX) $(ALL_CXXFLAGS) -MMD -MP -c -o $@ $<
endef
$(B)/%.o: src/%.c $(B)/flags
	$(compile)
$(B)/read/child/draco_decode.o: src/read/child/draco_decode.cc $(B)/flags
	$(compile_cxx)
# It follows one path at a time: fast to compile is enough.
$(B)/inspect/path_record.o: private ALL_CFLAGS := $(patsubst -O3,-O1,$(ALL_CFLAGS))
# It reads and writes files, and -O3 takes twice as long.
$(B)/image/stb.o: private ALL_CFLAGS := $(patsubst -O3,-O2,$(ALL_CFLAGS))
$(B)/read/gltf/gltf_draco.o: private ALL_CFLAGS += $(if $(DRACO),-DHAS_DRACO)
$(B)/render/cluster/wire.o: private ALL_CFLAGS += $(shell mpicc --showme:compile)
# The program that tries OpenCL devices and reads formats for the library.
$(B)/api/glim_scene.o: private ALL_CFLAGS += -DGLIM_PROGRAM='"$(BINDIR)/glim"'
$(B)/api/glim_scene.o $(L)/glim.pc: $(B)/places

# A change of flags or compiler rebuilds this variant; other places to install to
# rebuild what knows them.
$(B)/flags: FORCE
	@mkdir -p $(@D)
	@command -v $(firstword $(CC)) >/dev/null || \
		{ echo "no compiler '$(firstword $(CC))': try 'make deps'"; exit 1; }
	@echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@
$(B)/places: FORCE
	@mkdir -p $(@D)
	@echo '$(PREFIX) $(BINDIR) $(LIBDIR) $(INCLUDEDIR)' | cmp -s - $@ || \
		echo '$(PREFIX) $(BINDIR) $(LIBDIR) $(INCLUDEDIR)' > $@

## lib: libglim, the renderer for other programs, build/release/libglim.a and
##      libglim.so
lib: $(L)/libglim.a $(L)/libglim.so.$(VERSION) $(L)/glim.pc $(L)/libglim.so

# One object, in which only the functions of glim.h are visible.
$(L)/libglim.a: $(LIB_OBJECTS) $(B)/flags
	@mkdir -p $(@D)
	$(SAY) AR $@
	$(Q)$(CC) -r -nostdlib -o $(L)/libglim.o $(LIB_OBJECTS)
	$(Q)objcopy --localize-hidden $(L)/libglim.o
	$(Q)rm -f $@ && $(AR) rcs $@ $(L)/libglim.o

$(L)/libglim.so.$(VERSION): $(LIB_OBJECTS) $(B)/flags
	@mkdir -p $(@D)
	$(SAY) LINK $@
	$(Q)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,-z,defs \
		$(filter-out -pie,$(ALL_LDFLAGS)) -o $@ $(LIB_OBJECTS) $(LIB_LIBS)

$(L)/libglim.so: $(L)/libglim.so.$(VERSION)
	$(Q)ln -sf $(<F) $(L)/$(SONAME) && ln -sf $(<F) $@

$(L)/glim.pc: include/glim/version.h Makefile $(B)/flags
	@mkdir -p $(@D)
	$(Q)printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' \
		'includedir=$(INCLUDEDIR)' '' 'Name: glim' \
		'Description: path tracer for OBJ scenes' 'Version: $(VERSION)' \
		'Libs: -L$${libdir} -lglim' 'Libs.private: -pthread $(LIB_LIBS)' \
		'Cflags: -I$${includedir}' > $@

## run: installs missing packages, builds, opens SCENE (the Cornell box);
##      without a terminal it renders to a file
run:
	@CC='$(CC)' tests/tools/deps.sh build
	@+$(MAKE_ALL) $(L)/glim $(L)/tools/show
	@if [ -t 0 ] && [ -t 1 ]; then \
		$(L)/glim $(SCENE); \
	else \
		$(L)/glim -b -h 400 -s 64 -o build/run.png $(SCENE) && \
		$(L)/tools/show build/run.png && echo 'picture: build/run.png'; \
	fi

SCENE_FILES = $(foreach e,obj mtl glb view png hdr,$(wildcard scenes/*.$(e)))
PUBLIC_HEADERS := $(wildcard include/glim/*.h)
# Installs files: mode, folder, files.
put = $(INSTALL) -d '$(DESTDIR)$(2)' && $(INSTALL) -m $(1) $(3) '$(DESTDIR)$(2)'

## install: installs program, library, man pages and scenes; DESTDIR PREFIX
##          BINDIR LIBDIR INCLUDEDIR PKGCONFIGDIR MANDIR DATADIR
install: all lib
	$(call put,755,$(BINDIR),$(L)/$(if $(MPI),mpi/)glim)
	$(call put,644,$(LIBDIR),$(L)/libglim.a)
	$(call put,755,$(LIBDIR),$(L)/libglim.so.$(VERSION))
	ln -sf libglim.so.$(VERSION) '$(DESTDIR)$(LIBDIR)/$(SONAME)'
	ln -sf $(SONAME) '$(DESTDIR)$(LIBDIR)/libglim.so'
	$(call put,644,$(INCLUDEDIR)/glim,$(PUBLIC_HEADERS))
	$(call put,644,$(PKGCONFIGDIR),$(L)/glim.pc)
	$(call put,644,$(MANDIR)/man1,man/glim.1)
	$(call put,644,$(MANDIR)/man3,man/libglim.3)
	$(call put,644,$(DATADIR)/scenes,$(SCENE_FILES))

## uninstall: removes installed files
uninstall:
	rm -f '$(DESTDIR)$(BINDIR)/glim' '$(DESTDIR)$(MANDIR)/man1/glim.1' \
		'$(DESTDIR)$(MANDIR)/man3/libglim.3' '$(DESTDIR)$(PKGCONFIGDIR)/glim.pc' \
		$(patsubst %,'$(DESTDIR)$(LIBDIR)/%',libglim.a libglim.so $(SONAME) \
		libglim.so.$(VERSION)) \
		$(patsubst include/%,'$(DESTDIR)$(INCLUDEDIR)/%',$(PUBLIC_HEADERS)) \
		$(patsubst %,'$(DESTDIR)$(DATADIR)/%',$(SCENE_FILES))
	-rmdir '$(DESTDIR)$(INCLUDEDIR)/glim' '$(DESTDIR)$(DATADIR)/scenes' \
		'$(DESTDIR)$(DATADIR)'

## deps: lists packages missing for build and tests, and installs them
deps:
	@CC='$(CC)' tests/tools/deps.sh -v build test $(if $(MPI),mpi)

## clean: removes build/
clean:
	rm -rf build

include tests/tests.mk tests/bench/bench.mk

## help: prints this list
help:
	@sed -n 's/^## //p' $(filter %akefile %.mk,$(MAKEFILE_LIST))
	@echo 'variables: CC CFLAGS LDFLAGS SAN=address,undefined V=1 SCENE=FILE'

.PHONY: all lib run install uninstall deps clean help FORCE
-include $(OBJECTS:.o=.d) $(MPI_SOURCES:src/%.c=$(B)/%.d)
