# SPDX-License-Identifier: MIT
# bench.mk - measurements: speed, error against time, other renderers, documents

# Threads and seeds of `make bench-error`.
THREADS ?= 1
ROUNDS ?= 5
rounds = $(if $(filter file,$(origin ROUNDS)),3,$(ROUNDS))

## bench: measures speed, halting and threads; FILTER=NAME selects one;
##        FILTER=cost RENEW=1 records instructions a sample; AGAINST=COMMIT
##        measures speed beside it in turns
bench: $(L)/glim $(BENCHES) $(B)/rays/scaling
	@BUILD=$(L) CC='$(CC)' FILTER='$(FILTER)' RENEW='$(RENEW)' \
		AGAINST='$(AGAINST)' tests/bench/run.sh

## bench-mpi: measures one and two ranks of a cluster, if Open MPI is installed;
##            ROUNDS=3
bench-mpi: $(L)/mpi/glim
	@ROUNDS=$(rounds) tests/bench/mpi.sh $<

## bench-error: measures error against time, each technique on and off; text,
##              CSV and diagrams in build/bench-error/; FILTER=PART of the
##              scenes' names, THREADS=1 ROUNDS=5 (seeds)
bench-error: $(B)/error/error build/bench-error/scenes
	@mkdir -p build/bench-error/reference
	@{ $< build/bench-error '$(THREADS)' '$(ROUNDS)' '$(FILTER)'; \
		echo $$? > build/bench-error/status; } | \
		tee build/bench-error/report.txt; exit $$(cat build/bench-error/status)

# The CPU kernel with one function replaced, and unchanged, compiled for the
# processor that measures.
ERROR_BENCH := $(patsubst tests/bench/error/%.c,$(B)/error/%.o,$(filter-out \
	%/scenes.c,$(wildcard tests/bench/error/*.c))) $(patsubst \
	%,$(B)/error/paths_%.o,whole hashed uniform throughput shadows \
	collisions)
$(B)/error/paths_%.o: src/render/cpu_kernel.c tests/bench/error/%.h $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) -march=native -mprefer-vector-width=256 \
		-DPATHS=paths_$* -DPATHS_NAME='"$*"' \
		-include tests/bench/error/$*.h -MMD -MP -c -o $@ $<
$(B)/error/%.o: tests/bench/error/%.c $(B)/flags
	$(compile)
$(B)/error/error: $(ERROR_BENCH) $(L)/objects.a
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)
$(B)/error/scenes: $(B)/error/scenes.o $(B)/scenes/mesh.o $(L)/objects.a
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)
build/bench-error/scenes: $(B)/error/scenes
	@mkdir -p $@
	$(Q)$< $@ && touch $@

## bench-rays: compares rays per second with Embree 3 (libembree-dev);
##             FILTER=PART of the meshes' names, ISA=avx2
bench-rays:
	@echo '#include <embree3/rtcore.h>' | $(CC) -E -x c - >/dev/null 2>&1 || \
		{ echo 'bench-rays: needs Embree 3: install libembree-dev'; exit 1; }
	@+$(MAKE_ALL) $(B)/rays/rays
	@$(B)/rays/rays "$${GLIM_SHARED:-../shared}" '$(FILTER)' '$(ISA)'

RAYS_BENCH := $(patsubst tests/bench/rays/%.c,$(B)/rays/%.o,$(filter-out \
	%/scaling.c,$(wildcard tests/bench/rays/*.c))) \
	$(ISAS:%=$(B)/rays/glim_racer_%.o)
$(B)/rays/%.o: tests/bench/rays/%.c $(B)/flags
	$(compile)
$(ISAS:%=$(B)/rays/glim_racer_%.o): $(B)/rays/glim_racer_%.o: \
		tests/bench/rays/glim_racer.c $(B)/flags
	@mkdir -p $(@D)
	$(SAY) CC '$< ($*)'
	$(Q)$(CC) $(ALL_CFLAGS) $(FLAGS_$*) -DRACER=racer_$* -MMD -MP -c -o $@ $<
$(B)/rays/rays: $(RAYS_BENCH) $(L)/objects.a
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ -lembree3 $(LIBS)
$(B)/rays/scaling: $(B)/rays/scaling.o $(filter-out %/rays.o %/embree_racer.o, \
		$(RAYS_BENCH)) $(L)/objects.a
	$(SAY) LINK $@
	$(Q)$(CC) $(ALL_LDFLAGS) -o $@ $^ $(LIBS)

## bench-cycles: compares paths per second with Blender's Cycles, if Debian's
##               blender is installed; FILTER=SCENE, ROUNDS=3
bench-cycles: $(L)/glim
	@BUILD=$(L) FILTER='$(FILTER)' ROUNDS=$(rounds) tests/bench/cycles/run.sh

## results: measures the figures of docs/results.md and makes its tables and
##          diagrams; FILTER=SECTION selects one, FILTER=none only draws
results: $(L)/glim $(BENCHES) $(STRESSES) $(B)/rays/scaling \
		build/bench-error/scenes
	@BUILD=$(L) FILTER='$(FILTER)' tests/bench/results/measure.sh
	@BUILD=$(L) tests/bench/results/draw.sh

## gallery: renders the README's pictures into scenes/gallery/
gallery: $(L)/glim
	@BUILD=$(L) scenes/gallery/render.sh

## screens: takes the pictures of docs/screens.md in a real xterm
screens: $(L)/glim
	@GLIM=$(L)/glim tests/tools/screens.sh

.PHONY: bench bench-mpi bench-error bench-rays bench-cycles results gallery screens
-include $(ERROR_BENCH:.o=.d) $(RAYS_BENCH:.o=.d) $(B)/rays/scaling.d \
	$(B)/error/scenes.d
