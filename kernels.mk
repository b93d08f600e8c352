# SPDX-License-Identifier: MIT
# kernels.mk - builds of the kernels: on the CPU for each instruction set and each
# set of features, as text for OpenCL, and the loops of the denoising filter

KERNELS := $(sort $(wildcard kernels/*.h kernels/*.cl))

# Instruction sets, fastest first, and sets of features, fewest first; the sets
# are in src/render/feature_sets.h.
ISAS := $(if $(X86_64),avx512 avx2)
FLAGS_avx2 := -mavx2 -mfma -mbmi
FLAGS_avx512 := $(FLAGS_avx2) -mavx512f -mavx512vl -mavx512dq -mavx512bw \
	-mprefer-vector-width=256
SETS := lamps lamps_filter images images_filter shiny shiny_filter gltf \
	gltf_filter light
# gcc 12 packs components of vectors for operations on four, and spills what it
# has packed. Without that walls and lamps take 1 to 4 % less time; with most
# materials or a sky they take 3 to 7 % more.
FLAGS_lamps := -DFLATTEN -fno-tree-slp-vectorize
FLAGS_lamps_filter := $(FLAGS_lamps)

# BUILDS=few leaves out what this processor cannot run and all small sets of
# features but one: the builds that `make test` needs.
HOST_ISA := $(if $(filter few,$(BUILDS)),$(if $(X86_64),$(shell \
	grep -qw avx512vl /proc/cpuinfo && echo avx512 || \
	{ grep -qw avx2 /proc/cpuinfo && echo avx2; })))
PATHS_all := $(foreach isa,$(ISAS) plain,$(SETS:%=paths_$(isa)_%) paths_$(isa))
PATHS_few := $(foreach isa,$(HOST_ISA) plain,paths_$(isa)_lamps paths_$(isa))
PATHS := $(PATHS_$(BUILDS):%=$(B)/%.o)
FILTERS := $(ISAS:%=$(B)/film/filter/filter_loops_%.o)
KERNEL_OBJECTS := $(B)/kernels.o $(PATHS) $(FILTERS) $(B)/cpu_dispatch_$(BUILDS).o

# $* is the instruction set and, after a _, the set of features.
ISA = $(firstword $(subst _, ,$*))
SET = $(if $(findstring _,$*),$(patsubst $(ISA)_%,%,$*))

$(PATHS): $(B)/paths_%.o: src/render/cpu_kernel.c $(B)/flags
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) $(FLAGS_$(ISA)) $(FLAGS_$(SET)) -DPATHS=paths_$* \
		-DPATHS_NAME='"$(ISA)"' $(SET:%=-DSET=%) -MMD -MP -c -o $@ $<

$(B)/cpu_dispatch_all.o $(B)/cpu_dispatch_few.o: $(B)/cpu_dispatch_%.o: \
		src/render/cpu_dispatch.c $(B)/flags
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) '-DBUILDS(X)=$(PATHS_$*:%=X(%))' -MMD -MP -c -o $@ $<

$(FILTERS): $(B)/film/filter/filter_loops_%.o: src/film/filter/filter_loops.c $(B)/flags
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

-include $(KERNEL_OBJECTS:.o=.d)
